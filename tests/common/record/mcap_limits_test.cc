#include <cstring>

#include <gtest/gtest.h>

#include "common/record/mcap_reader.h"
#include "common/record/mcap_writer.h"

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

}  // namespace
}  // namespace palp::record
