#include "common/core/median.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(MedianTest, IsTheMiddleOrTheMeanOfBothMiddles) {
  EXPECT_EQ(median({}), std::nullopt);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

}  // namespace
}  // namespace palp
