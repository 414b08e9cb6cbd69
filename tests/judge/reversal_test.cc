#include "judge/reversal.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

TEST(ReversalTest, WhatCreepsOneWayHasNone) {
  Reversal creeping;
  for (int i = 0; i < 100; ++i) creeping.look(1e-4 * i);
  EXPECT_EQ(creeping.size(), 0);
}

TEST(ReversalTest, AnOscillationHasItsSwing) {
  Reversal swinging;
  for (int i = 0; i < 1000; ++i) swinging.look(3 + std::sin(0.02 * i));
  EXPECT_NEAR(swinging.size(), 2, 1e-3);
}

TEST(ReversalTest, OfATremblingCreepOnlyTheTremblingCounts) {
  Reversal both;
  for (int i = 0; i < 1000; ++i) both.look(0.01 * i + 0.1 * std::sin(0.5 * i));
  EXPECT_LT(both.size(), 0.2);
  EXPECT_GT(both.size(), 0.1);
}

TEST(ReversalTest, NothingSeenIsNone) { EXPECT_EQ(Reversal{}.size(), 0); }

}  // namespace
}  // namespace palp::judge
