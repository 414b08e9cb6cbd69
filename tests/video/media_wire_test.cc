#include "video/media_wire.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::video {
namespace {

Fragment some_fragment(const Bytes& data) {
  return {.jpeg = false,
          .key = false,
          .frame = 1000,
          .refers_back = 3,
          .captured_ns = 123'456'789'012,
          .size = 2500,
          .data_count = 3,
          .parity_count = 2,
          .index = 4,
          .offset_us = 4000,
          .data = data};
}

TEST(MediaWireTest, WhatIsWrittenIsReadBack) {
  const Bytes data(834, std::byte{9});
  const Bytes bytes = write(some_fragment(data));
  EXPECT_EQ(bytes.size(), 24U + 834U);
  const auto read = read_media(bytes);
  ASSERT_TRUE(read);
  const auto& fragment = std::get<Fragment>(*read);
  EXPECT_EQ(write(fragment), bytes);
  EXPECT_EQ(fragment.captured_ns, 123'456'789'012U);

  const Report report{.wants_recovery = true,
                      .wants_key = false,
                      .unwatched = true,
                      .newest_delivered = 77,
                      .delivered_before = 0x80000001U,
                      .standing_10us = 431,
                      .lost = 655,
                      .span_ratio = 300,
                      .rate_kbps = 2400,
                      .fragments_lost = 2,
                      .echo = 0x0123456789abcdefU};
  const Bytes said = write(report);
  EXPECT_EQ(said.size(), 29U);
  EXPECT_EQ(write(std::get<Report>(read_media(said).value())), said);
  EXPECT_EQ(std::get<Question>(read_media(write(Question{42})).value()).challenge, 42U);
  EXPECT_EQ(std::get<Word>(read_media(write(Word{VideoState::NoCamera})).value()).state,
            VideoState::NoCamera);
}

TEST(MediaWireTest, ContradictionsAreRefused) {
  const Bytes data(834, std::byte{9});
  const auto refused = [&](auto spoil) {
    Fragment one = some_fragment(data);
    spoil(one);
    return !read_media(write(one));
  };
  EXPECT_FALSE(refused([](Fragment&) {}));
  EXPECT_TRUE(refused([](Fragment& one) { one.size = 0; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.size = 2503; }));
  EXPECT_FALSE(refused([](Fragment& one) { one.size = 2502; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.data_count = 0; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.data_count = 97; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.parity_count = 126; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.index = 5; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.key = true; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.refers_back = 0; }));
  EXPECT_TRUE(refused([](Fragment& one) { one.frame = 2; }));
  EXPECT_TRUE(refused([&](Fragment& one) { one.data = std::span{data}.first(833); }));
}

RC_GTEST_PROP(MediaWireTest, AnyBytesAreReadOrRefused, (const std::vector<std::uint8_t>& any)) {
  Bytes bytes;
  for (const std::uint8_t byte : any) bytes.push_back(std::byte{byte});
  if (!bytes.empty()) bytes[0] = static_cast<std::byte>(any[0] % 6);
  const auto read = read_media(bytes);
  if (!read) return;
  const Bytes again = std::visit([](const auto& one) { return write(one); }, *read);
  RC_ASSERT(again == bytes);
}

}  // namespace
}  // namespace palp::video
