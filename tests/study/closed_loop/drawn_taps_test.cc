#include "study/closed_loop/drawn_taps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

/// Raised cosines from 3 mm above to `depth` [m] and back, a second each, and half a second of
/// pause; the tip follows `late` [ticks] behind the hand.
DrawnTaps seen_taps(int count, double depth, double stiffness, double step, int late = 0) {
  const auto position = [&](int i) {
    const double phase = 2 * std::numbers::pi * std::min(i % 1500, 1000) / 1000.0;
    return i < 0 ? -3e-3 : -3e-3 + (depth + 3e-3) * (1 - std::cos(phase)) / 2;
  };
  DrawnTaps taps{step};
  for (int i = 0; i < 1500 * count; ++i) {
    taps.see(position(i), stiffness * std::max(0.0, position(i - late)));
  }
  return taps;
}

TEST(DrawnTapsTest, EachTouchTellsItsGreatestForceOverTheDepth) {
  for (const int late : {0, 20, 250, 450}) {
    const DrawnTaps taps = seen_taps(3, 4e-3, 150, 0, late);
    ASSERT_EQ(taps.ln_stiffness().size(), 3U) << late;
    for (const double one : taps.ln_stiffness()) EXPECT_NEAR(std::exp(one), 150, 0.5) << late;
  }
}

TEST(DrawnTapsTest, TheForceIsReadInTheStepsOfTheSensor) {
  for (const double stiffness : {130.0, 135.0, 144.0}) {  // 0.52 to 0.576 N
    const DrawnTaps taps = seen_taps(2, 4e-3, stiffness, 50e-3);
    for (const double one : taps.ln_stiffness()) {
      const double steps = std::exp(one) * 4e-3 / 50e-3;
      EXPECT_NEAR(steps, std::round(stiffness * 4e-3 / 50e-3), 0.05);
    }
  }
}

TEST(DrawnTapsTest, WhatIsNotDrawnTellsNothing) {
  EXPECT_TRUE(seen_taps(3, 4e-3, 0, 0).ln_stiffness().empty());
  EXPECT_TRUE(seen_taps(3, 4e-3, 10, 0).ln_stiffness().empty());  // 40 mN
  EXPECT_TRUE(seen_taps(3, -1e-3, 150, 0).ln_stiffness().empty());
}

}  // namespace
}  // namespace palp::study
