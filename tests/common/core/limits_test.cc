#include "common/core/limits.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp {
namespace {

TEST(FiniteOrTest, ReplacesNotANumberAndBothInfinities) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(finite_or(std::numeric_limits<double>::quiet_NaN(), 2), 2);
  EXPECT_EQ(finite_or(kInfinity, 2), 2);
  EXPECT_EQ(finite_or(-kInfinity, 2), 2);
}

TEST(FiniteOrTest, KeepsEveryFiniteValue) {
  for (const double value : {0.0, -1.5, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(finite_or(value, 2), value);
  }
}

RC_GTEST_PROP(StepTowardsTest, NeverGoesFurtherThanItsStepNorPastItsTarget, ()) {
  const double from = *rc::gen::inRange(-1000, 1000) * 1e-3;
  const double target = *rc::gen::inRange(-1000, 1000) * 1e-3;
  const double step = *rc::gen::inRange(0, 500) * 1e-3;
  const double to = step_towards(from, target, step);
  RC_ASSERT(std::abs(to - from) <= step + 1e-15);
  RC_ASSERT(std::abs(target - to) <= std::abs(target - from));
  RC_ASSERT(std::abs(target - from) > step || std::abs(to - target) < 1e-15);
}

TEST(RampTest, RisesAndFallsLinearlyAndStopsAtTheEnds) {
  constexpr double kTick = 1e-3;  // [s]
  Ramp ramp;
  EXPECT_EQ(ramp.value(), 0);
  for (int n = 1; n <= 250; ++n) EXPECT_NEAR(ramp.rise(kTick, 0.5), n / 500.0, 1e-12);
  for (int n = 1; n <= 50; ++n) EXPECT_NEAR(ramp.fall(kTick, 0.2), 0.5 - n / 200.0, 1e-12);
  for (int n = 0; n < 1000; ++n) ramp.rise(kTick, 0.5);
  EXPECT_EQ(ramp.value(), 1);
  for (int n = 0; n < 1000; ++n) ramp.fall(kTick, 0.2);
  EXPECT_EQ(ramp.value(), 0);
}

TEST(RampTest, StartsWhereItIsSet) {
  Ramp ramp{1};
  EXPECT_EQ(ramp.value(), 1);
  ramp.set(0.25);
  EXPECT_NEAR(ramp.fall(0.1, 1), 0.15, 1e-12);
}

}  // namespace
}  // namespace palp
