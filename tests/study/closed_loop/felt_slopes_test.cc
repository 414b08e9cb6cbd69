#include "study/closed_loop/felt_slopes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::study {
namespace {

/// Raised cosines from 3 mm above to `depth` [m] and back, a second each.
FeltSlopes felt_taps(int count, double depth, double stiffness, double drag = 0) {
  FeltSlopes slopes;
  for (int i = 0; i < 1000 * count; ++i) {
    const double phase = 2 * std::numbers::pi * i / 1000.0;
    const double position = -3e-3 + (depth + 3e-3) * (1 - std::cos(phase)) / 2;
    const double pull = std::sin(phase) > 0 ? drag : -drag;
    slopes.feel(position, pull + stiffness * std::max(0.0, position));
  }
  return slopes;
}

TEST(FeltSlopesTest, EachWayInTellsTheStiffnessOfASpring) {
  const FeltSlopes slopes = felt_taps(3, 4e-3, 150);
  ASSERT_EQ(slopes.ln_slopes().size(), 3U);
  for (const double one : slopes.ln_slopes()) EXPECT_NEAR(std::exp(one), 150, 0.5);
}

TEST(FeltSlopesTest, DragIsNoStiffness) {
  const FeltSlopes slopes = felt_taps(2, 4e-3, 150, 0.2);
  ASSERT_EQ(slopes.ln_slopes().size(), 2U);
  for (const double one : slopes.ln_slopes()) EXPECT_NEAR(std::exp(one), 150, 1);
}

TEST(FeltSlopesTest, WhatIsNotFeltTellsNothing) {
  EXPECT_TRUE(felt_taps(3, 4e-3, 0).ln_slopes().empty());
  EXPECT_TRUE(felt_taps(3, 4e-3, 10).ln_slopes().empty());  // 40 mN
  EXPECT_TRUE(felt_taps(3, -1e-3, 150).ln_slopes().empty());
  EXPECT_TRUE(felt_taps(3, 4e-3, -150).ln_slopes().empty());  // antiphase
}

TEST(FeltSlopesTest, TremorIsNoTap) {
  FeltSlopes slopes;
  for (int i = 0; i < 3000; ++i) {
    const double position = 2e-3 + 0.1e-3 * std::sin(2 * std::numbers::pi * 9 * i / 1000.0);
    slopes.feel(position, 150 * position);
  }
  EXPECT_TRUE(slopes.ln_slopes().empty());
}

}  // namespace
}  // namespace palp::study
