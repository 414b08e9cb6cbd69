#include "common/coupling/rounding.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::coupling {
namespace {

TEST(RoundingTest, FindsTheNoiseBehindARoundingSensor) {
  for (const double noise : {0.25, 0.3, 0.5, 1.0, 2.0}) {  // over the quantum
    double square = 0;
    constexpr int kReadings = 20'000;
    for (int i = 0; i < kReadings; ++i) {
      const double reading = std::round(noise * random_normal(1, 2, static_cast<std::uint64_t>(i)));
      square += reading * reading / kReadings;
    }
    EXPECT_NEAR(noise_over_quantum(square) / noise, 1, 0.05) << noise;
  }
}

}  // namespace
}  // namespace palp::coupling
