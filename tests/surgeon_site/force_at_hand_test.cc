#include "surgeon_site/force_at_hand.h"

#include <gtest/gtest.h>

namespace palp::surgeon {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

HandFacts hand(double rate, double lag) {
  HandFacts facts;
  facts.rate = rate;
  facts.lag = lag;
  return facts;
}

TEST(ForceAtHandTest, AtTheUsualDeviceItIsTheForceOfTheLastTick) {
  ForceAtHand force{HandFacts{}, kPeriod};
  for (const double given : {1.0, 3.0, 2.0}) {
    force.give(given, 1);
    EXPECT_EQ(force.over(1e-3), given);
    EXPECT_EQ(force.over(-1e-3), given);
  }
}

TEST(ForceAtHandTest, BehindALagItIsTheForceOfThen) {
  ForceAtHand force{hand(1000, 5e-3), kPeriod};
  for (int tick = 0; tick < 40; ++tick) force.give(tick, 1);
  EXPECT_EQ(force.over(1e-3), 39 - 5);
  EXPECT_EQ(force.over(-1e-3), 39 - 5);
}

/// At 200 Hz a force that was given up to 8 ticks ago may still have worked.
TEST(ForceAtHandTest, ASlowDeviceIsBookedSoThatNoHandIsBelievedTooMuch) {
  ForceAtHand force{hand(200, 0), kPeriod};
  for (int tick = 0; tick < 40; ++tick) force.give(tick, 1);
  EXPECT_EQ(force.over(1e-3), 39 - 8);
  EXPECT_EQ(force.over(-1e-3), 39);
}

TEST(ForceAtHandTest, WhatALateTickSleptThroughWasHeld) {
  ForceAtHand force{hand(1000, 5e-3), kPeriod};
  force.give(2, 1);
  force.give(2, 4);
  force.give(7, 1);
  EXPECT_EQ(force.over(1e-3), 2);
}

TEST(ForceAtHandTest, AnyDeviceAndAnyPauseStayWithinItsMemory) {
  ForceAtHand force{hand(1, 10), kPeriod};
  force.give(1, 1'000'000'000);
  EXPECT_EQ(force.over(1e-3), 1);
  EXPECT_EQ(force.over(-1e-3), 1);
}

}  // namespace
}  // namespace palp::surgeon
