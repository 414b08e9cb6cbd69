#include "depth/quick_exp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

// Goal: as good as the library's where forces need it. Method: beside the library's, densely.
namespace palp::depth {
namespace {

double quick_exp_of(double x) {
  const auto all = quick_exp(std::array{0.0, x, 1.0});
  EXPECT_EQ(all[0], 1);
  return all[1];
}

TEST(QuickExpTest, IsTheExponential) {
  for (int i = -4000; i <= 4000; ++i) {
    const double x = 1e-3 * i;
    EXPECT_NEAR(quick_exp_of(x) / std::exp(x), 1, 1e-8) << x;
  }
  for (int i = -10000; i <= 400; ++i) {
    const double x = 0.01 * i;
    EXPECT_NEAR(quick_exp_of(x), std::exp(x), 1e-8 * std::max(1.0, std::exp(x))) << x;
  }
}

TEST(QuickExpTest, RisesAllTheWay) {
  double before = 0;
  for (int i = -30000; i <= 4000; ++i) {
    const double now = quick_exp_of(1e-3 * i);
    EXPECT_GT(now, before) << i;
    before = now;
  }
}

}  // namespace
}  // namespace palp::depth
