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

/// Readings of a force that rests, or of one that grows evenly through steps.
NoiseInSteps read_noise(double noise, double quantum, double first, double last) {
  NoiseInSteps out;
  constexpr int kCount = 4'000;
  for (int i = 0; i < kCount; ++i) {
    const double force = first + (last - first) * i / kCount;
    const double noisy = force + noise * random_normal(7, 2, static_cast<std::uint64_t>(i));
    out.add(force, quantum * std::round(noisy / quantum) - force, quantum);
  }
  return out;
}

TEST(NoiseInStepsTest, TheNoiseIsTheSameWhereverTheForceRests) {
  constexpr double kQuantum = 0.05;
  for (const double noise : {0.012, 0.015, 0.03, 0.08}) {
    for (const double force : {0.1, 0.11, 0.115, 0.24}) {
      const double rms = read_noise(noise, kQuantum, force, force).rms(kQuantum);
      EXPECT_NEAR(rms, std::hypot(noise, kQuantum / std::sqrt(12.0)), 0.06 * rms) << force;
    }
    const double rms = read_noise(noise, kQuantum, 0.05, 0.4).rms(kQuantum);
    EXPECT_NEAR(rms, std::hypot(noise, kQuantum / std::sqrt(12.0)), 0.03 * rms) << noise;
  }
}

TEST(NoiseInStepsTest, WithoutStepsItIsTheErrorsOwn) {
  NoiseInSteps fine;
  for (int i = 0; i < 1000; ++i) fine.add(0.1 + 1e-4 * i, i % 2 == 0 ? 1e-3 : -1e-3, 0);
  EXPECT_NEAR(fine.rms(0), 1e-3, 1e-12);
  EXPECT_NEAR(fine.rms(0.05), 1e-3, 1e-12) << "the transducer is finer than it says";
  EXPECT_TRUE(NoiseInSteps{}.empty());
  EXPECT_FALSE(fine.empty());
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
