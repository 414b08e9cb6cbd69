#include <cstring>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/record/mapped_file.h"
#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"
#include "tests/support/own_path.h"

namespace palp::record {
namespace {

/// A file of as many chunks as asked, each of `chunk` zero bytes in one message.
Bytes packed_zeros(int chunks, std::size_t chunk) {
  MemorySink sink;
  McapOptions options;
  options.chunk_size_max = chunk;
  {
    McapWriter writer{sink, options};
    const auto channel = writer.add_channel(0, "topic", "");
    for (int i = 0; i < chunks; ++i) {
      std::byte* place = writer.add_message({.channel = channel}, chunk - 100);
      std::memset(place, 0, chunk - 100);
    }
  }
  return {sink.bytes().begin(), sink.bytes().end()};
}

TEST(McapLimitsTest, ASmallFileCannotUnpackToALargeOne) {
  constexpr std::size_t kMega = std::size_t{1} << 20U;
  McapLimits limits;
  limits.unpacked_size_free = 4 * kMega;
  const Bytes bomb = packed_zeros(200, kMega);
  ASSERT_LT(bomb.size(), 100'000U);
  McapReader reader{bomb, limits};
  std::uint64_t unpacked = 0;
  while (const auto item = reader.next()) {
    if (const auto* message = std::get_if<McapMessage>(&*item)) unpacked += message->payload.size();
  }
  EXPECT_LE(unpacked, limits.unpacked_size_free + limits.unpacked_ratio_max * bomb.size());
  ASSERT_EQ(reader.report().faults.size(), 1U) << "one sentence";
  EXPECT_NE(reader.report().faults[0].text.find("256 times its size"), std::string::npos);
  EXPECT_FALSE(reader.report().closed);
  EXPECT_GT(reader.report().bytes_unread, 0U);

  McapReader patient{bomb, {.unpacked_size_free = 200 * kMega}};
  while (patient.next()) {
  }
  EXPECT_TRUE(patient.report().faults.empty()) << "below the limit all of it is read";
}

TEST(McapLimitsTest, AChunkIsNotReadThroughFillers) {
  Bytes packed;
  ASSERT_TRUE(ChunkCompressor{1}.compress(Bytes(50), packed));
  append(packed, std::uint32_t{0x184D2A50});  // a frame that decompressors skip
  append(packed, std::uint32_t{200});
  packed.resize(packed.size() + 200);
  EXPECT_EQ(ChunkDecompressor{1000}.decompress("zstd", packed, 50).error, "");
  EXPECT_NE(ChunkDecompressor{100}.decompress("zstd", packed, 50).error, "");
}

/// What this process has in memory, now ("VmRSS:") or at most ("VmHWM:"). [kB]
std::size_t resident(std::string_view line) {
  std::ifstream status{"/proc/self/status"};
  std::string word;
  while (status >> word && word != line) {
  }
  std::size_t size = 0;
  status >> size;
  return size;
}

/// By how much memory grew at most while `work` ran. [kB]
std::size_t growth(const auto& work) {
  std::ofstream{"/proc/self/clear_refs"} << 5;  // the most begins anew
  const std::size_t before = resident("VmRSS:");
  work();
  return resident("VmHWM:") - before;
}

TEST(McapLimitsTest, OfALongAttachmentOnlyAPieceIsInMemory) {
  constexpr std::size_t kSize = std::size_t{96} << 20U;  // [bytes]
  constexpr std::size_t kMost = 24 * 1024;               // [kB]
  const std::string base = test::own_path("long_attachment");
  std::ofstream{base + ".bin"}.close();
  ASSERT_EQ(truncate((base + ".bin").c_str(), kSize), 0);
  const auto data = MappedFile::open(base + ".bin");
  ASSERT_TRUE(data);
  EXPECT_LT(growth([&] {
              auto sink = FileSink::create(base + ".mcap");
              ASSERT_TRUE(sink);
              McapWriter{*sink, {}}.add_attachment(
                  {.name = "camera", .media_type = {}, .data = data->bytes()});
            }),
            kMost);
  const auto file = MappedFile::open(base + ".mcap");
  ASSERT_TRUE(file);
  McapReader reader{file->bytes()};
  EXPECT_LT(growth([&] {
              while (const auto item = reader.next()) {
                const auto* one = std::get_if<McapAttachment>(&*item);
                EXPECT_TRUE(one == nullptr || one->data.size() == kSize);
              }
            }),
            kMost);
  EXPECT_EQ(reader.report().attachments, 1U);
  EXPECT_EQ(reader.report().fault_count, 0U) << "the checksums are those of all pieces";
  EXPECT_TRUE(reader.report().closed);
  (void)std::remove((base + ".bin").c_str());
  (void)std::remove((base + ".mcap").c_str());
}

TEST(McapLimitsTest, NamesThatACopyWouldKeepAreLimited) {
  MemorySink sink;
  {
    McapWriter writer{sink, {}};
    for (int k = 0; k < 5; ++k) {
      writer.add_attachment({.name = "a name of 20 letters", .media_type = {}, .data = {}});
      writer.add_metadata("another one of 26 letters.", {});
    }
  }
  const auto read = [&](std::uint64_t limit) {
    McapReader reader{sink.bytes(), {.names_size_max = limit}};
    while (reader.next()) {
    }
    return reader.report();
  };
  constexpr std::uint64_t kBoth = 64 + 20 + 64 + 26;
  EXPECT_EQ(read(5 * kBoth).fault_count, 0U);
  EXPECT_EQ(read(5 * kBoth - 1).metadata, 4U);
  EXPECT_EQ(read(5 * kBoth - 1).attachments, 5U);
  EXPECT_EQ(read(kBoth).attachments, 1U);
  EXPECT_GT(read(kBoth).fault_count, 0U);
}

}  // namespace
}  // namespace palp::record
