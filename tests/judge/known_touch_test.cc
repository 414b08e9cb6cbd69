#include "judge/known_touch.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

MetricsConfig far_away() {
  MetricsConfig config;
  config.force_continuous = 1.4;
  config.stiffest = 1500;
  config.round_trip = 0.5;
  return config;
}

/// Felt and true stiffness [N/m], `offset` [N] on top of what is felt, begun at `at` [s].
TapMetrics tap(double at, double felt, double truth, double offset = 0) {
  TapMetrics tap;
  tap.began_at = at;
  for (int k = 0; k < 40; ++k) {
    const double x = 1.3e-3 + 2e-3 * k / 39;
    tap.stiffness.add(x, 0.01, offset + felt * x, truth * x);
  }
  return tap;
}

/// First touched at 1 s, 4 mm deep.
KnownTouch touched() {
  KnownTouch touch{far_away()};
  touch.look(0.9, 0.5e-3, 0.01);
  touch.look(1, 4e-3, 0.06);
  touch.look(3, 6e-3, 2);
  return touch;
}

/// From `from` [s] on: forces felt and true [N], the hand 4 mm deep.
KnownTouch::Hold held(double from, double felt, double truth) {
  return {.from = from, .until = from + 1, .position = 4e-3, .felt = felt, .truth = truth};
}

TEST(KnownTouchTest, ATapIsJudgedOnceNewsOfTheFirstContactCanBeThere) {
  KnownTouch touch = touched();
  touch.tap(tap(1.8, 10, 200));
  EXPECT_TRUE(std::isnan(touch.tap_error()));
  touch.tap(tap(1.9, 220, 200));
  EXPECT_NEAR(touch.tap_error(), 0.1, 1e-9);
}

TEST(KnownTouchTest, TapsAreJudgedByTheirSlopesWhateverTheForceTheyBeginWith) {
  KnownTouch touch = touched();
  touch.tap(tap(2, 200, 200));
  touch.tap(tap(3, 200, 200, 0.5));
  EXPECT_NEAR(touch.tap_error(), 0, 1e-9);
}

TEST(KnownTouchTest, WhatNoLawMayShowIsNotJudged) {
  KnownTouch touch = touched();
  touch.tap(tap(2, 1500, 2500));
  EXPECT_TRUE(std::isnan(touch.tap_error()));
  touch.hold(held(6, 1.35, 5));
  touch.hold(held(6, 0.001, 0.02));
  EXPECT_TRUE(std::isnan(touch.held_error()));
}

TEST(KnownTouchTest, AHoldOfTissueTooSteepToBeShownIsNotJudged) {
  KnownTouch touch = touched();
  KnownTouch::Hold steep = held(6, 0.5, 1);
  steep.position = 0.6e-3;
  touch.hold(steep);
  EXPECT_TRUE(std::isnan(touch.held_error()));
  steep.position = 0.7e-3;
  touch.hold(steep);
  EXPECT_NEAR(touch.held_error(), 0.5, 1e-9);
}

TEST(KnownTouchTest, AHoldIsJudgedWhereTheEnergyPermitsItInItsOwnContact) {
  MetricsConfig config = far_away();
  config.bound = {.grip = 300, .energy = 0.3e-3};
  KnownTouch touch{config};
  touch.look(1, 4e-3, 0.06);
  // In one second to a true force [N], with nothing felt; then in the air.
  const auto press = [&](double from, double truth) {
    for (int i = 0; i < 1000; ++i) {
      const double share = 1e-3 * i;
      touch.feel({.at = from + share, .truth = truth * share, .position = 4e-3 * share});
    }
    touch.hold(held(from, 0.5 * truth, truth));
    touch.feel({.at = from + 1});
  };
  press(5, 1.3);
  EXPECT_TRUE(std::isnan(touch.held_error()));
  press(8, 0.45);
  EXPECT_NEAR(touch.held_error(), 0.5, 1e-9);
  press(11, 1.3);
  EXPECT_NEAR(touch.held_error(), 0.5, 1e-9);
}

TEST(KnownTouchTest, ATapDeeperThanAnythingTouchedBeforeIsNotJudged) {
  KnownTouch touch{far_away()};
  touch.look(1, 1e-3, 0.06);
  touch.look(4, 2e-3, 0.1);
  touch.look(5, 3.2e-3, 0.1);
  touch.tap(tap(5, 220, 200));
  EXPECT_TRUE(std::isnan(touch.tap_error()));
  touch.tap(tap(6, 220, 200));
  EXPECT_NEAR(touch.tap_error(), 0.1, 1e-9);
}

TEST(KnownTouchTest, ATapOfAForceThatTheMotorsDoNotStandIsNotJudged) {
  KnownTouch touch = touched();
  touch.tap(tap(2, 300, 420));  // to 1.39 N
  EXPECT_TRUE(std::isnan(touch.tap_error()));
}

TEST(KnownTouchTest, ATapThatOnlyJustReachesTheWindowHasNoSlope) {
  KnownTouch touch = touched();
  TapMetrics short_tap;
  short_tap.began_at = 2;
  for (int k = 0; k < 40; ++k) {
    const double x = 1.25e-3 + 1e-6 * k;
    short_tap.stiffness.add(x, 0.01, 400 * x, 200 * x);
  }
  touch.tap(short_tap);
  EXPECT_TRUE(std::isnan(touch.tap_error()));
}

TEST(KnownTouchTest, HoldsThatAreTooSoftDoNotMakeUpForThoseThatAreTooHard) {
  KnownTouch touch = touched();
  touch.hold(held(3.4, 0.1, 0.5));  // too early
  touch.hold(held(4, 0.4, 0.5));
  touch.hold(held(9, 0.6, 0.5));
  EXPECT_NEAR(touch.held_error(), 0.2, 1e-9);
}

TEST(KnownTouchTest, ASiteThatWasNeverTouchedIsNotJudged) {
  KnownTouch touch{far_away()};
  touch.tap(tap(5, 220, 200));
  touch.hold(held(9, 0.6, 0.5));
  EXPECT_TRUE(std::isnan(touch.tap_error()));
  EXPECT_TRUE(std::isnan(touch.held_error()));
}

}  // namespace
}  // namespace palp::judge
