#include "common/core/jump_allowance.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kSpan = 0.01;  // [s]

TEST(JumpAllowanceTest, ASpeedWithinItsLimitIsNoJump) {
  JumpAllowance place{0.3};
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(place.jumped(0.3 * kSpan, kSpan));
}

TEST(JumpAllowanceTest, OneJumpOfTwoMillimetresIsForgivenAndMoreIsNot) {
  JumpAllowance place{0.3};
  EXPECT_FALSE(place.jumped(-0.3 * kSpan - 1.99e-3, kSpan));
  place.reset();
  EXPECT_TRUE(place.jumped(0.3 * kSpan + 2.01e-3, kSpan));
}

TEST(JumpAllowanceTest, WhoJumpsToAndFroAtTheLimitIsFound) {
  JumpAllowance place{0.3};
  const double most = 0.3 * kSpan + 1.99e-3;
  EXPECT_FALSE(place.jumped(most, kSpan));
  EXPECT_TRUE(place.jumped(-most, kSpan));
}

TEST(JumpAllowanceTest, ALateStampNowAndThenIsNone) {
  JumpAllowance place{0.3};
  for (int i = 0; i < 20; ++i) {
    ASSERT_FALSE(place.jumped(0.3 * kSpan + 1.5e-3, kSpan));
    for (int k = 0; k < 50; ++k) ASSERT_FALSE(place.jumped(0.1 * kSpan, kSpan));
  }
}

}  // namespace
}  // namespace palp
