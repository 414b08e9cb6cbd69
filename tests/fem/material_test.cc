#include "fem/material.h"

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

constexpr Gradient kState{1.1, 0.2, -0.15, 0.8, 1.05};

TEST(MaterialTest, CofactorIsTheDerivativeOfTheVolume) {
  const double step = 1e-6;
  const Gradient c = cofactor(kState);
  const GradientMatrix h = volume_curvature(kState);
  for (std::size_t i = 0; i < 5; ++i) {
    Gradient up = kState;
    Gradient down = kState;
    up[i] += step;
    down[i] -= step;
    EXPECT_NEAR((volume_ratio(up) - volume_ratio(down)) / (2 * step), c[i], 1e-9);
    for (std::size_t j = 0; j < 5; ++j) {
      EXPECT_NEAR((cofactor(up)[j] - cofactor(down)[j]) / (2 * step), h[j][i], 1e-9);
    }
  }
}

TEST(MaterialTest, StressAndTangentAreDerivativesOfTheEnergy) {
  const double step = 1e-6;
  const Isochoric at = isochoric(kState, 3);
  for (std::size_t i = 0; i < 5; ++i) {
    Gradient up = kState;
    Gradient down = kState;
    up[i] += step;
    down[i] -= step;
    const Isochoric above = isochoric(up, 3);
    const Isochoric below = isochoric(down, 3);
    EXPECT_NEAR((above.energy - below.energy) / (2 * step), at.stress[i], 1e-8);
    for (std::size_t j = 0; j < 5; ++j) {
      EXPECT_NEAR((above.stress[j] - below.stress[j]) / (2 * step), at.tangent[j][i], 1e-7);
    }
  }
}

TEST(MaterialTest, PureVolumeChangeCostsNoIsochoricEnergy) {
  const Isochoric at = isochoric({1.3, 0, 0, 1.3, 1.3}, 3);
  EXPECT_NEAR(at.energy, 0, 1e-12);
  for (const double component : at.stress) EXPECT_NEAR(component, 0, 1e-12);
}

}  // namespace
}  // namespace palp::fem
