#include "video/parity.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::video {
namespace {

RC_GTEST_PROP(ParityTest, AnyFragmentsAsManyAsTheDataGiveItBack, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 97);
  const auto spare = *rc::gen::inRange<std::size_t>(0, 129 - count > 33 ? 33 : 129 - count);
  const auto size = *rc::gen::inRange<std::size_t>(1, 40);
  std::vector<Bytes> data(count, Bytes(size));
  for (Bytes& one : data) {
    for (std::byte& byte : one) byte = static_cast<std::byte>(*rc::gen::inRange(0, 256));
  }
  std::vector<Bytes> fragments = data;
  for (Bytes& one : make_parity(data, spare)) fragments.push_back(std::move(one));
  auto lost = *rc::gen::inRange<std::size_t>(0, spare + 1);
  while (lost > 0) {
    Bytes& one = fragments[*rc::gen::inRange<std::size_t>(0, fragments.size())];
    if (one.empty()) continue;
    one.clear();
    --lost;
  }
  RC_ASSERT(repair(fragments, count));
  fragments.resize(count);
  RC_ASSERT(fragments == data);
}

TEST(ParityTest, OneTooFewIsNotRepaired) {
  const std::vector<Bytes> data(4, Bytes(10, std::byte{7}));
  std::vector<Bytes> fragments = data;
  for (Bytes& one : make_parity(data, 2)) fragments.push_back(std::move(one));
  for (const std::size_t lost : {0U, 3U, 5U}) fragments[lost].clear();
  EXPECT_FALSE(repair(fragments, 4));
}

TEST(ParityTest, TheFieldIsThatOfItsPolynomial) {
  // Row 0, column 0: 1/255 with x^8 + x^4 + x^3 + x^2 + 1; 253 * 255 = 1 there.
  const Bytes parity = make_parity({Bytes{std::byte{1}}}, 1).front();
  EXPECT_EQ(parity.front(), std::byte{253});
}

}  // namespace
}  // namespace palp::video
