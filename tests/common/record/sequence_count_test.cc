#include "common/record/sequence_count.h"

#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::record {
namespace {

SequenceCount count_of(const std::vector<std::uint32_t>& numbers) {
  SequenceCount count;
  for (const std::uint32_t number : numbers) count.see(number);
  return count;
}

TEST(SequenceCountTest, ASoundSequenceLacksNothing) {
  const SequenceCount count = count_of({0, 1, 2, 3});
  EXPECT_EQ(count.missing(), 0U);
  EXPECT_EQ(count.disordered(), 0U);
}

TEST(SequenceCountTest, GapsAreMissingAlsoBeforeTheFirst) {
  EXPECT_EQ(count_of({2, 3, 7}).missing(), 5U);
  EXPECT_EQ(count_of({0xFFFF'FFFF}).missing(), 0xFFFF'FFFFU);
}

TEST(SequenceCountTest, APartBeginsWhereItBegins) {
  SequenceCount count{500};
  count.see(500);
  EXPECT_EQ(count.missing(), 0U);
}

TEST(SequenceCountTest, WhatIsThereTwiceIsNotMissing) {
  const SequenceCount count = count_of({0, 1, 2, 1, 2, 3});
  EXPECT_EQ(count.missing(), 0U);
  EXPECT_EQ(count.disordered(), 2U);
}

TEST(SequenceCountTest, WhatComesLateIsNotMissing) {
  const SequenceCount swapped = count_of({0, 1, 4, 5, 2, 3, 6});
  EXPECT_EQ(swapped.missing(), 0U);
  EXPECT_EQ(swapped.disordered(), 2U);
}

TEST(SequenceCountTest, OfAnyOrderWhatIsMissingIsWhatIsNotThere) {
  std::vector<std::uint32_t> numbers(200);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random{seed, 1};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<std::uint32_t>(random.bits(i) % 300);
    }
    const std::set<std::uint32_t> there{numbers.begin(), numbers.end()};
    EXPECT_EQ(count_of(numbers).missing(), *there.rbegin() + 1 - there.size()) << seed;
  }
}

}  // namespace
}  // namespace palp::record
