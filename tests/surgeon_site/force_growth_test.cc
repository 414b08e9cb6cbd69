#include "surgeon_site/force_growth.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;

/// The force after so many ticks of a hand of that speed [m/s], towards one that is out of reach.
double grown(ForceGrowth& growth, double speed, int ticks, double target = 100) {
  double force = 0;
  for (int i = 0; i < ticks; ++i) {
    growth.move(1e-3 * speed, 1ms);
    force = growth.grow(force, target);
  }
  return force;
}

TEST(ForceGrowthTest, UnderAHandAtRestAForceGrowsByItsSlew) {
  ForceGrowth growth{{}};
  EXPECT_NEAR(grown(growth, 0, 100), 4.0, 1e-9);
}

TEST(ForceGrowthTest, AlongTheHandsWayItGrowsAsInTheStiffestTissue) {
  ForceGrowth growth{{}};
  const double way = 0.1 * 50e-3;  // [m]
  EXPECT_NEAR(grown(growth, 0.1, 50), 1500 * way + 40 * 50e-3 + 15 * 0.1, 0.01);
}

TEST(ForceGrowthTest, AWayOutExplainsOnlyAForceThatPullsTheHandIn) {
  ForceGrowth pushed{{}};
  EXPECT_NEAR(grown(pushed, -0.1, 50), 2.0, 1e-9);
  ForceGrowth pulled{{}};
  EXPECT_LT(grown(pulled, -0.1, 50, -100), -7);
}

TEST(ForceGrowthTest, AMotionExplainsNothingForLong) {
  ForceGrowth growth{{}};
  growth.move(10e-3, 1ms);
  for (int i = 0; i < 200; ++i) growth.move(0, 1ms);
  EXPECT_LE(growth.grow(0, 100), 0.06);
}

TEST(ForceGrowthTest, OfALateTickOnePeriodsShareExplains) {
  ForceGrowth growth{{.damping = 0}};
  growth.move(100e-3, {1ms, 100});
  EXPECT_NEAR(growth.grow(0, 100), 1500 * 1e-3 + 0.04, 1e-9);
}

TEST(ForceGrowthTest, ASmallTargetIsReachedExactly) {
  ForceGrowth growth{{}};
  growth.move(0, 1ms);
  EXPECT_EQ(growth.grow(0, 0.03), 0.03);
}

}  // namespace
}  // namespace palp::surgeon
