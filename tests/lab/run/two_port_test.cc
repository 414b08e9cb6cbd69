#include "lab/run/two_port.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::lab {
namespace {

TwoPortSetup setup_of(const char* name, double round_trip, double frequency) {
  TwoPortSetup setup{.round_trip = round_trip, .frequency = frequency};
  setup.coupling.name = name;
  return setup;
}

/// [N/m], what a spring of that impedance would be.
std::complex<double> stiffness_of(const Impedance& impedance, double frequency) {
  return impedance * std::complex<double>{0, 2 * std::numbers::pi * frequency};
}

TEST(TwoPortTest, SlowlyALawShowsTheSpringThatTheTipIsIn) {
  for (const char* name : {"direct", "wave", "tdpa", "mmt"}) {
    for (const double stiffness : {100.0, 300.0}) {
      const TwoPortSetup setup = setup_of(name, 0, 0.2);
      const double shown =
          stiffness_of(transmitted_impedance(setup, stiffness), setup.frequency).real();
      EXPECT_NEAR(shown, stiffness, 0.15 * stiffness) << name;
    }
  }
}

TEST(TwoPortTest, ASpringFeltLateIsSofterAndPushes) {
  // direct: k cos(w T) in phase, and -k sin(w T)/w of damping.
  const Impedance near = transmitted_impedance(setup_of("direct", 0, 1), 300);
  const Impedance far = transmitted_impedance(setup_of("direct", 0.1, 1), 300);
  EXPECT_LT(stiffness_of(far, 1).real(), 0.95 * stiffness_of(near, 1).real());
  EXPECT_LT(far.real(), near.real() - 5) << "[N s/m]";
}

TEST(TwoPortTest, AModelAtTheHandShowsTheSameWhateverTheRoundTrip) {
  const Impedance near = transmitted_impedance(setup_of("mmt", 0.02, 2), 200);
  const Impedance far = transmitted_impedance(setup_of("mmt", 0.3, 2), 200);
  EXPECT_NEAR(std::abs(far / near), 1, 0.05);
}

TEST(TwoPortTest, ADelayWithoutACouplingIsNotAbsolutelyStable) {
  // h12 h21 = -exp(-i w T): the margin is cos(w T) without any damping of its own.
  const HybridMatrix delay{
      .h11 = 0, .h12 = std::polar(1.0, -0.5), .h21 = -std::polar(1.0, -0.5), .h22 = 0};
  EXPECT_NEAR(absolute_stability(delay).margin, std::cos(1.0), 1e-12);
  EXPECT_FALSE(absolute_stability(delay).holds());
  EXPECT_FALSE(absolute_stability(hybrid_matrix(setup_of("direct", 0.1, 3))).holds());
}

TEST(TwoPortTest, ALinearLawHasNoAmplitude) {
  for (const char* name : {"direct", "wave"}) {
    ASSERT_TRUE(is_linear(name));
    TwoPortSetup setup = setup_of(name, 0.1, 2);
    const Impedance small = transmitted_impedance(setup, 0);
    const HybridMatrix of_small = hybrid_matrix(setup);
    setup.amplitude *= 3;
    EXPECT_NEAR(std::abs(transmitted_impedance(setup, 0) / small), 1, 0.01) << name;
    EXPECT_NEAR(std::abs(hybrid_matrix(setup).h21 / of_small.h21), 1, 0.01) << name;
  }
}

TEST(TwoPortTest, APassiveNetworkIsAbsolutelyStable) {
  // A damper in series with a line that has none: [b 1; -1 0].
  EXPECT_TRUE(absolute_stability({.h11 = 5, .h12 = 1, .h21 = -1, .h22 = 0}).holds());
  EXPECT_FALSE(absolute_stability({.h11 = -5, .h12 = 1, .h21 = -1, .h22 = 0}).holds());
}

}  // namespace
}  // namespace palp::lab
