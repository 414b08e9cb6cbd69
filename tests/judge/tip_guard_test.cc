#include "judge/tip_guard.h"

#include <gtest/gtest.h>

namespace palp::judge {
namespace {

TEST(TipGuardTest, BelowTheLimitThereIsNothing) {
  TipGuard guard{3};
  guard.look(0, 2.9);
  EXPECT_EQ(guard.excess(), 0);
  EXPECT_EQ(guard.longest(), 0);
}

TEST(TipGuardTest, TimesThatForceIsBeyondDoNotAddUp) {
  TipGuard guard{3};
  for (const double began : {0.0, 1.0}) {
    for (int i = 0; i <= 50; ++i) guard.look(began + 1e-3 * i, 3.2);
    guard.look(began + 0.1, 3.05);
  }
  EXPECT_NEAR(guard.excess(), 0.2, 1e-12);
  EXPECT_NEAR(guard.longest(), 0.05, 1e-12);
}

TEST(TipGuardTest, LittleBeyondIsNoTime) {
  TipGuard guard{3};
  for (int i = 0; i <= 50; ++i) guard.look(1e-3 * i, 3.09);
  EXPECT_NEAR(guard.excess(), 0.09, 1e-12);
  EXPECT_EQ(guard.longest(), 0);
}

}  // namespace
}  // namespace palp::judge
