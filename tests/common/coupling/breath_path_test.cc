#include "common/coupling/breath_path.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

constexpr double kRate = 1.6;  // [rad/s]

double swings(double at) { return 0.7 * std::sin(kRate * at); }

/// Sees a surface that swings by sine for 12 s, and is displaced by `unknown` [mm] more than is
/// supposed.
BreathPath<2> follow(double unknown) {
  BreathPath<2> path{kRate};
  for (int i = 0; i < 300; ++i) {
    if (i > 0) path.pass(0.04);
    path.see(swings(0.04 * i) + unknown, 1e-4, {1, 0});
  }
  return path;
}

TEST(BreathPathTest, ForeseesASwingForAQuarterOfASecond) {
  BreathPath<2> path = follow(0);
  const double now = 0.04 * 299;
  EXPECT_NEAR(path.displacement(), swings(now), 0.01);
  path.pass(0.25);
  EXPECT_NEAR(path.displacement(), swings(now + 0.25), 0.06);
}

TEST(BreathPathTest, ItsDoubtGrowsWithoutASightAndFallsWithOne) {
  BreathPath<2> path = follow(0);
  const double seen = path.variance();
  path.pass(1);
  const double unseen = path.variance();
  EXPECT_GT(unseen, 4 * seen);
  path.see(0, 1e-4, {});
  EXPECT_LT(path.variance(), 1e-4);
}

/// To the first order the shares say what the path would be with another unknown.
TEST(BreathPathTest, GoesOverToAnotherUnknown) {
  BreathPath<2> path = follow(0);
  path.change({0.1, 0});
  EXPECT_NEAR(path.displacement(), follow(0.1).displacement(), 1e-6);
}

}  // namespace
}  // namespace palp::coupling
