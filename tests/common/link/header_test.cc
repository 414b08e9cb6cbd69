#include "common/link/header.h"

#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/link/transport.h"
#include "common/message/limits.h"

namespace palp::link {
namespace {

std::vector<std::byte> packed(const Header& header) {
  std::vector<std::byte> bytes(kHeaderSize + header.length);
  pack_header(header, std::span{bytes}.first<kHeaderSize>());
  return bytes;
}

const Header kSome{.type = PacketType::Data,
                   .key = 1,
                   .length = 100,
                   .connection = 0x01020304,
                   .number = 0x0005060708090A0BULL};

RC_GTEST_PROP(HeaderTest, ComesBackAsItWasPacked, ()) {
  const Header header{
      .type = *rc::gen::element(PacketType::Data,
                                PacketType::Control,
                                PacketType::Path,
                                PacketType::Close,
                                PacketType::Media),
      .key = *rc::gen::inRange<std::uint8_t>(0, 4),
      .length = *rc::gen::inRange<std::uint16_t>(0, kDatagramSizeMax - kHeaderSize + 1),
      .connection = *rc::gen::arbitrary<std::uint32_t>(),
      .number = *rc::gen::inRange<std::uint64_t>(0, message::kNumberMax + 1),
  };
  const auto parsed = parse_header(packed(header));
  RC_ASSERT(parsed.has_value());
  RC_ASSERT(parsed->type == header.type);
  RC_ASSERT(parsed->key == header.key);
  RC_ASSERT(parsed->length == header.length);
  RC_ASSERT(parsed->connection == header.connection);
  RC_ASSERT(parsed->number == header.number);
}

RC_GTEST_PROP(HeaderTest, WhatParsesPacksToTheSameBytes, ()) {
  auto bytes = packed(kSome);
  const auto bit = *rc::gen::inRange<std::size_t>(0, 8 * kHeaderSize);
  bytes[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
  if (const auto parsed = parse_header(bytes)) RC_ASSERT(packed(*parsed) == bytes);
}

TEST(HeaderTest, BytesAreBigEndianInTheDocumentedPlaces) {
  const auto bytes = packed(kSome);
  const std::vector<int> expected{0x80, 0x40, 0, 100, 1, 2, 3, 4, 0, 5, 6, 7, 8, 9, 10, 11};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
  }
}

TEST(HeaderTest, RefusesEveryOtherVersion) {
  auto bytes = packed(kSome);
  for (unsigned version = 0; version < 16; ++version) {
    bytes[0] = static_cast<std::byte>(version << 4U);
    EXPECT_EQ(parse_header(bytes).has_value(), version == kHeaderVersion) << version;
  }
}

TEST(HeaderTest, RefusesUnknownTypes) {
  auto bytes = packed(kSome);
  for (unsigned type = 0; type < 16; ++type) {
    bytes[0] = static_cast<std::byte>(0x80U | type);
    EXPECT_EQ(parse_header(bytes).has_value(), type <= 3 || type == 5) << type;
  }
}

TEST(HeaderTest, RefusesEveryReservedFlag) {
  auto bytes = packed(kSome);
  for (unsigned flag = 0; flag < 6; ++flag) {
    bytes[1] = static_cast<std::byte>(1U << flag);
    EXPECT_FALSE(parse_header(bytes)) << flag;
  }
}

TEST(HeaderTest, RefusesEveryLengthButTheTrueOne) {
  const auto whole = packed(kSome);
  for (std::size_t size = 0; size < 300; ++size) {
    auto bytes = whole;
    bytes.resize(size);
    EXPECT_EQ(parse_header(bytes).has_value(), size == whole.size()) << size;
  }
}

TEST(HeaderTest, RefusesWhatIsLongerThanADatagramOfOursWhateverItsLengthSays) {
  for (const std::size_t size : {1199U, 1200U, 1201U, 1400U, 65'000U}) {
    Header header = kSome;
    header.length = static_cast<std::uint16_t>(size - kHeaderSize);
    EXPECT_EQ(parse_header(packed(header)).has_value(), size <= kDatagramSizeMax) << size;
  }
}

TEST(HeaderTest, RefusesNumbersPastTheLimit) {
  Header header = kSome;
  header.number = message::kNumberMax;
  auto bytes = packed(header);
  EXPECT_TRUE(parse_header(bytes));
  bytes[15] = std::byte{1};
  EXPECT_FALSE(parse_header(bytes));
}

}  // namespace
}  // namespace palp::link
