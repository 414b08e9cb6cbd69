#include "common/core/line_fit.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

RC_GTEST_PROP(LineFitTest, FindsTheSlopeOfAnyLineFarFromTheOrigin, ()) {
  const double slope = *rc::gen::inRange(-1000, 1000) * 0.01;
  const double offset = *rc::gen::inRange(-1000, 1000) * 10.0;
  const double first = *rc::gen::inRange(-1000, 1000) * 1.0;
  LineFit fit;
  for (int i = 0; i < 20; ++i) fit.add(first + i * 1e-3, offset + slope * i * 1e-3);
  RC_ASSERT(fit.count() == 20);
  RC_ASSERT(std::abs(fit.slope() - slope) < 1e-6);
}

RC_GTEST_PROP(LineFitTest, DoesNotDependOnWhereTheOriginLies, ()) {
  const auto heights = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 1000));
  const double shift_x = *rc::gen::inRange(-1'000'000, 1'000'000);
  const double shift_y = *rc::gen::inRange(-1'000'000, 1'000'000);
  RC_PRE(heights.size() >= 2);
  LineFit home;
  LineFit away;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto x = static_cast<double>(i);
    home.add(x, heights[i]);
    away.add(x + shift_x, heights[i] + shift_y);
  }
  RC_ASSERT(std::abs(away.slope() - home.slope()) < 1e-6);
}

TEST(LineFitTest, SmallDifferencesSurviveLargeOffsets) {
  // Squares of x near 2^60 beside steps of 2^-10: their plain sums would drown the steps.
  const double offset = std::ldexp(1, 30);
  LineFit fit;
  for (int i = 0; i < 1000; ++i) fit.add(offset + std::ldexp(i, -10), offset - std::ldexp(i, -9));
  EXPECT_NEAR(fit.slope(), -2.0, 1e-4);
}

TEST(LineFitTest, WeighsEveryPointAlike) {
  LineFit fit;
  for (const double y : {0.0, 1.0, 0.0, 1.0}) fit.add(static_cast<double>(fit.count()), y);
  EXPECT_NEAR(fit.slope(), 0.2, 1e-12);  // sum of dx dy = 1, of dx^2 = 5
}

}  // namespace
}  // namespace palp
