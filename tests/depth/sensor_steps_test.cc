// Goal: what rounding does to a noisy force is known. Method: readings drawn and rounded.
#include "depth/sensor_steps.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::depth {
namespace {

TEST(SensorStepsTest, MeanAndVarianceAreThoseOfRoundedReadings) {
  constexpr double kNoise = 0.015;  // [N], before the steps
  constexpr double kQuantum = 0.05;
  const SensorSteps steps{std::hypot(kNoise, kQuantum / std::sqrt(12.0)), kQuantum};
  for (const double force : {0.0, 0.1, 0.11, 0.123, 0.137, 0.249}) {
    constexpr int kCount = 40'000;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < kCount; ++i) {
      const double noisy = force + kNoise * random_normal(5, 1, static_cast<std::uint64_t>(i));
      const double off = kQuantum * std::round(noisy / kQuantum) - force;
      sum += off;
      squares += off * off;
    }
    const double mean = sum / kCount;
    const double variance = squares / kCount - mean * mean;
    const SensorSteps::Reading reading = steps.at(force);
    EXPECT_NEAR(reading.offset, mean, 5 * std::sqrt(variance / kCount)) << force;
    EXPECT_NEAR(reading.variance, variance, 0.05 * variance) << force;
    constexpr double kStep = 1e-4;
    const double slope =
        1 + (steps.at(force + kStep).offset - steps.at(force - kStep).offset) / (2 * kStep);
    EXPECT_NEAR(reading.slope, slope, 0.03) << force;
  }
}

TEST(SensorStepsTest, AQuietSensorHasNoSteps) {
  for (const SensorSteps& steps : {SensorSteps{1e-3, 0.05}, SensorSteps{1e-3, 0}}) {
    EXPECT_EQ(steps.at(0.113).offset, 0);
    EXPECT_EQ(steps.at(0.113).slope, 1);
    EXPECT_DOUBLE_EQ(steps.at(0.113).variance, 1e-6);
  }
}

}  // namespace
}  // namespace palp::depth
