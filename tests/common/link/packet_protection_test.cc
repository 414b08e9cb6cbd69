#include "common/link/packet_protection.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/common/link/whole_open.h"

namespace palp::link {
namespace {

RC_GTEST_PROP(PlainProtectionTest, OpensWhatItSealed, ()) {
  const auto content =
      *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::arbitrary<std::uint8_t>());
  const auto plain = std::as_bytes(std::span{content});
  PlainProtection protection;
  std::vector<std::byte> datagram(2000);
  const std::size_t size = protection.seal({.connection = 7, .number = 9}, plain, datagram);
  RC_ASSERT(size == kHeaderSize + plain.size() + protection.overhead());
  datagram.resize(size);

  const auto header = parse_header(datagram);
  RC_ASSERT(header.has_value());
  RC_ASSERT(header->number == 9U);
  std::vector<std::byte> opened(2000);
  const auto opened_size = whole_open(protection, datagram, opened);
  RC_ASSERT(opened_size.has_value());
  RC_ASSERT(std::equal(plain.begin(),
                       plain.end(),
                       opened.begin(),
                       opened.begin() + static_cast<std::ptrdiff_t>(*opened_size)));
}

TEST(PlainProtectionTest, SealsNothingWhereTheRoomIsTooSmall) {
  PlainProtection protection;
  const std::array<std::byte, 10> plain{};
  std::array<std::byte, kHeaderSize + 10> out{};
  EXPECT_EQ(protection.seal({}, plain, std::span{out}.first(out.size() - 1)), 0U);
  EXPECT_EQ(protection.seal({}, plain, out), out.size());
}

TEST(PlainProtectionTest, RefusesToOpenWhatIsNotWholeOrDoesNotFit) {
  PlainProtection protection;
  const std::array<std::byte, 10> plain{};
  std::array<std::byte, kHeaderSize + 10> datagram{};
  ASSERT_EQ(protection.seal({}, plain, datagram), datagram.size());
  std::array<std::byte, 10> room{};
  EXPECT_EQ(whole_open(protection, std::span{datagram}.first(20), room).error(),
            Rejection::Malformed);
  EXPECT_EQ(whole_open(protection, datagram, std::span{room}.first(9)).error(),
            Rejection::Malformed);
  EXPECT_EQ(whole_open(protection, datagram, room).value(), 10U);
}

}  // namespace
}  // namespace palp::link
