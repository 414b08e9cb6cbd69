#include "common/coupling/sensor_noise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::coupling {
namespace {

constexpr double kQuantum = 0.05;  // [N]

double rounded(double force) { return kQuantum * std::round(force / kQuantum); }

/// Noise of `spread` [N], rounded, in the air.
SensorNoise heard(double spread, int ticks) {
  SensorNoise noise;
  for (int k = 0; k < ticks; ++k) {
    noise.listen(rounded(spread * random_normal(1, 2, static_cast<std::uint64_t>(k))));
  }
  return noise;
}

TEST(SensorNoiseTest, NobodyKnowsNoiseBeforeAFifthOfASecond) {
  EXPECT_FALSE(heard(0.02, 199).known());
  EXPECT_TRUE(heard(0.02, 200).known());
}

TEST(SensorNoiseTest, TheDeviationIsThatOfTheReadings) {
  // 5 % of it: the newest 1,000 readings count most, and leave some 2 % open.
  EXPECT_NEAR(heard(0.2, 4000).deviation(), std::sqrt(0.04 + kQuantum * kQuantum / 12), 0.01);
}

/// Goal: what rounding adds in the mean is known. Method: the mean of many rounded noisy readings.
TEST(SensorNoiseTest, TheBiasIsTheMeanErrorOfRounding) {
  constexpr double kSpread = 0.3 * kQuantum;
  constexpr int kReadings = 200'000;
  SensorNoise noise = heard(kSpread, 4000);
  EXPECT_EQ(noise.bias(0.26 * kQuantum, kQuantum), 0) << "not settled";
  noise.settle(kQuantum);
  for (const double steps : {0.1, 0.25, 0.4, 3.7}) {
    const double force = steps * kQuantum;
    double sum = 0;
    for (int k = 0; k < kReadings; ++k) {
      sum += rounded(force + kSpread * random_normal(3, 4, static_cast<std::uint64_t>(k))) - force;
    }
    // A tenth of the largest bias: what is learned of the noise in 4 s is not exact.
    EXPECT_NEAR(noise.bias(force, kQuantum), sum / kReadings, 0.006 * kQuantum) << steps;
  }
}

TEST(SensorNoiseTest, WithLittleNoiseTheMeanOfManyReadingsIsInDoubt) {
  const auto doubt = [](double spread, double quantum) {
    SensorNoise noise = heard(spread, 4000);
    noise.settle(quantum);
    return noise.doubt();
  };
  EXPECT_EQ(doubt(0, kQuantum), kQuantum / 2);
  EXPECT_EQ(doubt(0.3 * kQuantum, kQuantum), 0);
  EXPECT_EQ(doubt(0.3 * kQuantum, 0), 0);
}

TEST(SensorNoiseTest, WithoutStepsOrWithoutNoiseThereIsNoBias) {
  SensorNoise fine = heard(0.02, 1000);
  fine.settle(0);
  EXPECT_EQ(fine.bias(0.013, 0), 0);
  SensorNoise still = heard(0, 1000);
  still.settle(kQuantum);
  EXPECT_EQ(still.bias(0.013, kQuantum), 0);
}

}  // namespace
}  // namespace palp::coupling
