#include "common/coupling/told_force.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::coupling {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{1};

RC_GTEST_PROP(ToldForceTest, IsNeverFasterThanThatAndTheStiffestTissueExplain, ()) {
  const ToldForceConfig config;
  ToldForce told{config};
  double before = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double wanted = *rc::gen::inRange(-9000, 9001) * 1e-3;
    const double way = *rc::gen::inRange(-300, 301) * 1e-6;
    const double now = told.step(wanted, way, kPeriod);
    RC_ASSERT(std::abs(now - before) <=
              config.slew * 1e-3 + config.stiffness * std::abs(way) + 1e-12);
    before = now;
  }
}

TEST(ToldForceTest, FollowsTissueAsStiffAsThatWithoutLag) {
  ToldForce told{{.slew = 0, .stiffness = 370}};
  double position = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const double next = 4e-3 * std::sin(0.02 * tick);
    const double force = told.step(370 * next, next - position, kPeriod);
    EXPECT_NEAR(force, 370 * next, 1e-9);
    position = next;
  }
}

TEST(ToldForceTest, WhatWasHeldBackIsGivenAfterAllAndNotMoreOfALiesSumThanItsLimit) {
  const ToldForceConfig config;
  for (const double step : {0.4, 8.0}) {
    ToldForce told{config};
    double owed = 0;  // [N s]
    double highest = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      const double force = told.step(step, 0, kPeriod);
      owed += (step - force) * 1e-3;
      highest = std::max(highest, force);
    }
    EXPECT_LE(highest, step + config.owed_max / config.repay_time) << step;
    if (step < 1) {
      EXPECT_NEAR(owed, 0, 1e-5);
    }
  }
}

TEST(ToldForceTest, ALateTickIsWorthOnePeriod) {
  ToldForce told{{.slew = 25, .stiffness = 370}};
  const double force = told.step(9, 0.02, Lapse{kPeriod, 100});
  EXPECT_NEAR(force, 25e-3 + 370 * 0.02 / 100, 1e-12);
}

}  // namespace
}  // namespace palp::coupling
