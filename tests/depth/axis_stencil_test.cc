#include "depth/axis_stencil.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palp::depth {
namespace {

template <typename Function>
double between(const std::vector<double>& axis, double x, Function of) {
  const AxisStencil at = axis_stencil(axis, x);
  EXPECT_LE(at.first + at.count, axis.size());
  double sum = 0;
  for (std::size_t i = 0; i < at.count; ++i) sum += at.weight[i] * of(axis[at.first + i]);
  return sum;
}

double parabola(double x) { return 2 - x + 0.5 * x * x; }

TEST(AxisStencilTest, AParabolaComesOutFromThreePointsOn) {
  for (const std::vector<double>& axis :
       {std::vector<double>{0, 1, 3}, {0, 1, 3, 4}, {0, 1, 3, 4, 7, 9}}) {
    for (double x = -0.5; x < axis.back() + 0.5; x += 0.25) {
      EXPECT_NEAR(between(axis, x, parabola), parabola(x), 1e-12) << axis.size() << ' ' << x;
    }
  }
}

TEST(AxisStencilTest, TwoPointsMakeALineAndOneAConstant) {
  EXPECT_NEAR(between({1, 3}, 2.5, [](double x) { return 4 * x; }), 10, 1e-12);
  EXPECT_EQ(between({2}, 17, parabola), parabola(2));
}

TEST(AxisStencilTest, ThePointsAreMetAndTheSlopeDoesNotJumpThere) {
  const std::vector<double> axis{0, 0.4, 1, 1.3, 2, 3};
  const auto sine = [](double x) { return std::sin(2 * x); };
  for (const double node : axis) EXPECT_NEAR(between(axis, node, sine), sine(node), 1e-12);
  constexpr double kStep = 1e-6;
  for (std::size_t i = 1; i + 1 < axis.size(); ++i) {
    const double left = sine(axis[i]) - between(axis, axis[i] - kStep, sine);
    const double right = between(axis, axis[i] + kStep, sine) - sine(axis[i]);
    EXPECT_NEAR(left / kStep, right / kStep, 1e-4);
  }
}

}  // namespace
}  // namespace palp::depth
