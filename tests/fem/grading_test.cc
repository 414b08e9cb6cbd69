#include "fem/grading.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

TEST(GradingTest, SpansTheLineInOrder) {
  const auto at = distribute({.length = 3, .first = 0.1, .last = 0.02, .growth = 0.4}, 12);
  ASSERT_EQ(at.size(), 25U);
  EXPECT_EQ(at.front(), 0);
  EXPECT_EQ(at.back(), 3);
  EXPECT_TRUE(std::is_sorted(at.begin(), at.end()));
}

TEST(GradingTest, ElementsHaveTheSizesAskedForWhenTheirNumberFits) {
  const Grading grading{.length = 10, .first = 0.1, .last = 1e9, .growth = 0.2};
  const int count = static_cast<int>(elements_wanted(grading) + 0.5);
  const auto at = distribute(grading, count);
  EXPECT_NEAR(at[2], 0.11, 0.01);  // first + growth * x, seen from its middle
  EXPECT_NEAR(at.back() - at[at.size() - 3], 1.9, 0.15);
}

TEST(GradingTest, SmoothExtremesStayOnTheirSide) {
  EXPECT_LE(smooth_min(2, 3), 2);
  EXPECT_GE(smooth_max(2, 3), 3);
  EXPECT_NEAR(smooth_min(1, 100), 1, 1e-9);
}

}  // namespace
}  // namespace palp::fem
