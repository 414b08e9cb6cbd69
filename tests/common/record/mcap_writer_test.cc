#include "common/record/mcap_writer.h"

#include <array>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "common/record/mcap_reader.h"

namespace palp::record {
namespace {

TEST(McapWriterTest, CrcIsTheOneOfZlib) {
  EXPECT_EQ(crc32(std::as_bytes(std::span{"123456789", 9})), 0xCBF43926u);
}

/// Takes `room` bytes, then no more, as a disk that fills up.
class FullDisk final : public ByteSink {
 public:
  explicit FullDisk(std::size_t room) : room_{room} {}
  bool write(std::span<const std::byte> bytes) noexcept override {
    if (bytes.size() > room_) {
      return false;
    }
    room_ -= bytes.size();
    return true;
  }

 private:
  std::size_t room_;
};

TEST(McapWriterTest, FullDiskEndsTheRecordingAndCountsEveryMessageLost) {
  FullDisk disk{3000};
  McapOptions options;
  options.compression = McapCompression::None;
  options.chunk_size_max = 500;
  McapWriter writer{disk, options};
  const auto channel = writer.add_channel(0, "topic", "");
  for (std::uint64_t k = 0; k < 200; ++k) {
    if (std::byte* place = writer.add_message({.channel = channel, .log_time = k}, 20)) {
      std::memset(place, 0, 20);
    }
  }
  writer.close();
  EXPECT_TRUE(writer.failed());
  EXPECT_GT(writer.counts().messages, 0u);
  EXPECT_GT(writer.counts().lost, 0u);
  EXPECT_EQ(writer.counts().messages + writer.counts().lost, 200u);
}

TEST(McapWriterTest, ChunkIsWrittenWhenItsOldestMessageIsHalfASecondOld) {
  NullSink sink;
  McapWriter writer{sink, {}};
  const auto channel = writer.add_channel(0, "topic", "");
  writer.add_message({.channel = channel, .log_time = 1'000'000'000}, 0);
  writer.flush_if_due(1'499'999'999);
  EXPECT_EQ(writer.counts().chunks, 0u);
  writer.flush_if_due(1'500'000'000);
  EXPECT_EQ(writer.counts().chunks, 1u);
  writer.flush_if_due(9'000'000'000);
  EXPECT_EQ(writer.counts().chunks, 1u) << "nothing was waiting";
}

TEST(McapWriterTest, ChunkNeverExceedsItsSizeUnlessOneMessageDoes) {
  MemorySink sink;
  McapOptions options;
  options.chunk_size_max = 1000;
  {
    McapWriter writer{sink, options};
    const auto channel = writer.add_channel(0, "topic", "");
    for (std::uint64_t k = 0; k < 100; ++k) {
      std::memset(writer.add_message({.channel = channel, .log_time = k}, 100), 0, 100);
    }
    std::memset(writer.add_message({.channel = channel, .log_time = 100}, 5000), 0, 5000);
  }
  McapReader narrow{sink.bytes(), {.chunk_size_max = 1000}};
  while (narrow.next()) {
  }
  EXPECT_EQ(narrow.report().messages, 100u);
  EXPECT_EQ(narrow.report().chunks_damaged, 1u) << "the one with the large message";
}

TEST(McapWriterTest, MessageOnAChannelThatWasNeverAddedIsRefused) {
  NullSink sink;
  McapWriter writer{sink, {}};
  EXPECT_EQ(writer.add_message({.channel = 1}, 4), nullptr);
  EXPECT_EQ(writer.counts().lost, 1u);
}

}  // namespace
}  // namespace palp::record
