#include "common/core/filters.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kPeriod = 1e-3;  ///< [s]
constexpr double kRounding = 1e-12;

TEST(LowPassTest, StepResponseIsTheSampledExponential) {
  constexpr double kCutOff = 20;  // [Hz]
  LowPass filter{kCutOff, kPeriod};
  for (int n = 1; n <= 200; ++n) {
    const double expected = 1 - std::exp(-2 * std::numbers::pi * kCutOff * n * kPeriod);
    EXPECT_NEAR(filter.step(1), expected, kRounding) << "n = " << n;
  }
}

TEST(LowPassTest, RestAtItsInputStaysThere) {
  LowPass filter{50, kPeriod};
  filter.reset(3.5);
  for (int n = 0; n < 10; ++n) EXPECT_EQ(filter.step(3.5), 3.5);
  EXPECT_EQ(filter.value(), 3.5);
}

TEST(LowPassTest, AttenuatesASineAtItsCutOffByHalfThePower) {
  constexpr double kCutOff = 10;  // [Hz], far below the sampling rate
  LowPass filter{kCutOff, kPeriod};
  double peak = 0;
  for (int n = 0; n < 2000; ++n) {
    const double out = filter.step(std::sin(2 * std::numbers::pi * kCutOff * n * kPeriod));
    if (n > 1000) peak = std::max(peak, std::abs(out));
  }
  EXPECT_NEAR(peak, std::numbers::sqrt2 / 2, 0.03);  // of the sampled form: 3 % at 10 Hz
}

TEST(LowPassDeathTest, RefusesACutOffThatIsNotPositive) {
  EXPECT_DEATH((LowPass{0, kPeriod}), "positive cut-off");
  EXPECT_DEATH((LowPass{20, 0}), "positive cut-off");
}

TEST(VelocityEstimateTest, FirstSampleGivesZeroWhereverItIs) {
  VelocityEstimate estimate{30, kPeriod};
  EXPECT_EQ(estimate.step(0.123), 0);
}

TEST(VelocityEstimateTest, ApproachesTheSlopeOfARampLikeItsLowPass) {
  constexpr double kSlope = 0.05;  // [m/s]
  VelocityEstimate estimate{30, kPeriod};
  LowPass same{30, kPeriod};
  estimate.step(0);
  for (int n = 1; n < 200; ++n) {
    EXPECT_NEAR(estimate.step(kSlope * n * kPeriod), same.step(kSlope), kRounding);
  }
  EXPECT_NEAR(estimate.value(), kSlope, 1e-9);
}

TEST(VelocityEstimateTest, ResetForgetsThePositionBefore) {
  VelocityEstimate estimate{30, kPeriod};
  estimate.step(0);
  estimate.step(0.01);
  EXPECT_GT(estimate.value(), 0);
  estimate.reset();
  EXPECT_EQ(estimate.step(5), 0);
}

}  // namespace
}  // namespace palp
