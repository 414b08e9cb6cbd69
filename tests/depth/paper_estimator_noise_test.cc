#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

/// Error of the median h of 8 taps, share of h.
double median_error(const Phantom& phantom, double expected, std::uint64_t seed, double depth) {
  SimulatedPhantomConfig config;
  config.seed = seed;
  std::vector<double> hashes;
  for (const DepthEstimate& estimate : tap(phantom, config, {.indentation = depth})) {
    hashes.push_back(estimate.hash);
  }
  EXPECT_EQ(hashes.size(), 8U);
  std::sort(hashes.begin(), hashes.end());
  return (hashes[3] + hashes[4]) / 2 / expected - 1;
}

// Goal: with the transducer's noise and steps and with damping, the median h of 8 taps lies within
// 3 % of the curve's for nearly all seeds. Method: 200 seeds a phantom, taps of 3.9 mm and of
// 3.3 mm (where a hand that presses as hard gets on stiffer tissue), 95th percentile.
class NoisyTaps : public ::testing::TestWithParam<const char*> {};

TEST_P(NoisyTaps, MedianOfEightIsWithinThreePercent) {
  const auto phantom = make_phantom(GetParam());
  ASSERT_TRUE(phantom);
  const double expected = hash_of(phantom->over);
  for (const double depth : {3.9e-3, 3.3e-3}) {
    std::vector<double> errors;
    double bias = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
      const double error = median_error(*phantom, expected, seed, depth);
      bias += error / 200;
      errors.push_back(std::abs(error));
    }
    std::sort(errors.begin(), errors.end());
    std::printf(
        "%s %.1f mm: |error of median h| p50 %.2f %% p95 %.2f %% max %.2f %%, bias %.2f %%\n",
        GetParam(),
        depth * 1e3,
        errors[100] * 100,
        errors[190] * 100,
        errors[199] * 100,
        bias * 100);
    // A short stroke leaves more to the law: 3.4 % there.
    EXPECT_LT(errors[190], depth > 3.5e-3 ? 0.03 : 0.034);
    EXPECT_LT(std::abs(bias), 0.015);
  }
}

INSTANTIATE_TEST_SUITE_P(
    SharedCurves,
    NoisyTaps,
    ::testing::Values("none", "paper-25mm", "paper-20mm", "paper-15mm", "paper-10mm", "paper-5mm"),
    [](const auto& one) {
      std::string name = one.param;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

}  // namespace
}  // namespace palp::patient
