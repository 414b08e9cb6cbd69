#include "review/thinned.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace palp::review {
namespace {

TEST(ThinnedTest, AShortListIsWholeAndALongOneKeepsEquallyDistantOnes) {
  for (const std::size_t size : {0U, 1U, 7U, 8U, 9U, 16U, 17U, 33U, 1000U}) {
    Thinned<std::size_t> list{8};
    for (std::size_t i = 0; i < size; ++i) list.add(i);
    const std::vector<std::size_t> kept = list.take();
    ASSERT_LE(kept.size(), 8U);
    ASSERT_GE(kept.size(), std::min<std::size_t>(size, 4));
    ASSERT_TRUE(size > 8 || kept.size() == size);
    const std::size_t stride = kept.size() < 2 ? 1 : kept[1] - kept[0];
    for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i], i * stride) << size;
    if (size == 0) continue;
    EXPECT_LT(size - 1 - kept.back(), stride) << "up to the end";
  }
}

}  // namespace
}  // namespace palp::review
