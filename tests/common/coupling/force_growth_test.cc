#include "common/coupling/force_growth.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/filters.h"

namespace palp::coupling {
namespace {

using std::chrono_literals::operator""ms;

/// The force after so many ticks of a hand of that speed [m/s], towards one that is out of reach.
double grown(ForceGrowth& growth, double speed, int ticks, double target = 100) {
  double force = 0;
  for (int i = 0; i < ticks; ++i) {
    growth.move(1e-3 * speed, speed, 1ms);
    force = growth.follow(force, target);
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
  growth.move(10e-3, 0, 1ms);
  for (int i = 0; i < 200; ++i) growth.move(0, 0, 1ms);
  EXPECT_LE(growth.follow(0, 100), 0.06);
}

TEST(ForceGrowthTest, OfALateTickOnePeriodsShareExplains) {
  ForceGrowth growth{{.damping = 0}};
  growth.move(100e-3, 1, {1ms, 100});
  EXPECT_NEAR(growth.follow(0, 100), 1500 * 1e-3 + 0.04, 1e-9);
}

TEST(ForceGrowthTest, ASmallTargetIsReachedExactly) {
  ForceGrowth growth{{}};
  growth.move(0, 0, 1ms);
  EXPECT_EQ(growth.follow(0, 0.03), 0.03);
}

TEST(ForceGrowthTest, AForceThatFallsOrTurnsIsNotHeldUp) {
  ForceGrowth growth{{}};
  EXPECT_EQ(growth.follow(2, 0.5), 0.5);
  EXPECT_EQ(growth.follow(2, -1), 0);
  EXPECT_EQ(growth.follow(-2, -0.5), -0.5);
}

TEST(ForceGrowthTest, ASpringUnderAQuickHandIsLeftAlone) {
  ForceGrowth growth{{.slew = 1e-9, .at_once = 0}};
  double force = 0;
  double before = 0;
  for (int i = 0; i <= 500; ++i) {
    const double position = 1e-3 * (1 - std::cos(0.15 * i));  // [m], 24 Hz
    growth.move(position - before, 0, 1ms);
    before = position;
    force = growth.follow(force, 1400 * position);
    ASSERT_NEAR(force, 1400 * position, 0.15 * 1400 * 2e-3) << i;
  }
}

TEST(ForceGrowthTest, AChangeIsBoundedToBothSides) {
  ForceGrowth still{{}};
  double force = 2;
  for (int i = 0; i < 10; ++i) {
    still.move(0, 0, 1ms);
    force = still.change(force, -1);
  }
  EXPECT_NEAR(force, 2 - 0.4, 1e-9);
  ForceGrowth moved{{}};
  moved.move(-1e-3, 0, 1ms);
  EXPECT_NEAR(moved.change(2, -1), 2 - 1.5 - 0.04, 1e-9) << "the hand left";
  moved.move(1e-3, 0, 1ms);
  EXPECT_NEAR(moved.change(2, -1), 2 - 0.04, 1e-9) << "it came in: that explains no fall";
}

/// A hand at rest where an encoder cannot decide between two counts, and a peer that lies.
RC_GTEST_PROP(ForceGrowthTest, AnEncoderThatCannotDecideExplainsNoMoreThanItsStep, ()) {
  const double step = *rc::gen::element(5e-6, 30e-6, 100e-6);  // [m]
  const ForceGrowthConfig config;
  ForceGrowth growth{config};
  VelocityEstimate estimate{60, 1e-3};
  double position = 0;
  double force = 0;
  double slowest = 0;
  double fastest = 0;
  std::deque<double> last(10, 0.0);
  for (int i = 0; i < 300; ++i) {
    const double before = std::exchange(position, *rc::gen::element(0.0, step));
    const double velocity = estimate.step(position, 1);
    slowest = std::min(slowest, velocity);
    fastest = std::max(fastest, velocity);
    growth.move(position - before, velocity, 1ms);
    force = growth.follow(force, *rc::gen::element(0.0, 1.0, 100.0));
    const double swing = config.stiffness * step + config.damping * (fastest - slowest);
    // What leaks away in the memory comes again.
    const double again = swing * 10e-3 / config.memory;
    RC_ASSERT(force - *std::ranges::min_element(last) <= 0.45 + swing + again + 1e-9);
    last.pop_front();
    last.push_back(force);
  }
}

}  // namespace
}  // namespace palp::coupling
