#include "common/coupling/breathing_estimator.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;

double hertz(double depth) { return depth > 0 ? 1897 * depth * std::sqrt(depth) : 0; }

/// Four taps of 4 mm from 3 mm above the surface at rest, then a press of 3 mm.
double palpating(double t) {
  if (t > 6) return std::min(3e-3, -3e-3 + 10e-3 * (t - 6));
  const double phase = std::fmod(t, 1.5);
  return -3e-3 + (phase < 1 ? 3.5e-3 * (1 - std::cos(2 * std::numbers::pi * phase)) : 0);
}

/// A tip that palpates for `span` [s] at a surface that moves as `displacement`(t) [m], from
/// `begin` [s] on.
template <class Displacement>
void palpate(BreathingEstimator& swing,
             double begin,
             double span,
             const Displacement& displacement) {
  const int ticks = static_cast<int>(span / kPeriod);
  for (int tick = 0; tick < ticks; ++tick) {
    const double t = kPeriod * tick;
    const double tip = palpating(t);
    const double noise = 3e-3 * random_normal(1, 2, static_cast<std::uint64_t>(tick));
    swing.step();
    swing.see(tip, hertz(tip - displacement(begin + t)) + noise);
  }
}

TEST(BreathingEstimatorTest, FindsABreathOfAnyPaceAndSizeWithTheTissueUnderItAndForeseesIt) {
  for (const double pace : {0.15, 0.25, 0.4}) {
    for (const double size : {0.5e-3, 2e-3}) {
      const double rate = 2 * std::numbers::pi * pace;
      const auto breath = [&](double t) { return 0.3e-3 + size * std::sin(rate * t + 0.4); };
      BreathingEstimator swing{kPeriod};
      palpate(swing, 0, 16, breath);
      ASSERT_TRUE(swing.believed()) << pace << ' ' << size;
      const Swing found = swing.swing();
      EXPECT_NEAR(found.rate / rate, 1, 0.01) << pace << ' ' << size;
      for (const double ahead : {0.0, 0.1, 0.25}) {
        EXPECT_NEAR(swing.surface() + found.after(ahead), breath(16 + ahead), 0.05e-3)
            << pace << " Hz, " << size << " m, " << ahead << " s ahead";
      }
      const auto& shapes = swing.shapes();
      const double at_three = shapes[0] * 3 * std::sqrt(3 / 1.3) + shapes[1] * 9 + shapes[2] * 27;
      EXPECT_NEAR(at_three / hertz(3e-3), 1, 0.03) << pace << ' ' << size;
    }
  }
}

TEST(BreathingEstimatorTest, SaysNothingOfASurfaceThatStandsStillOrTrembles) {
  for (const double size : {0.0, 0.05e-3}) {
    BreathingEstimator swing{kPeriod};
    palpate(swing, 0, 16, [&](double t) { return 0.3e-3 + size * std::sin(1.5 * t); });
    EXPECT_FALSE(swing.believed()) << size;
    EXPECT_EQ(swing.swing().now, 0) << size;
    EXPECT_TRUE(swing.still()) << size;
  }
}

TEST(BreathingEstimatorTest, AnotherPlaceBreathesWithTheSameBreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  ASSERT_TRUE(swing.believed());
  swing.new_place(kSiteB);
  palpate(swing, 16, 9, [&](double t) { return 2e-3 + breath(t); });
  EXPECT_NEAR(swing.surface() + swing.swing().now, 2e-3 + breath(25), 0.1e-3);
}

TEST(BreathingEstimatorTest, ADragOverManyPlacesDoesNotEndABreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  ASSERT_TRUE(swing.believed());
  double t = 16;
  for (int place = 0; place < 40; ++place) {
    swing.new_place({1.1e-3 * (place + 1), 0});
    const double stiffer = 1 + 0.5 * std::sin(1.3 * place);
    for (int tick = 0; tick < 500; ++tick, t += kPeriod) {
      const double tip = 3e-3 + 0.5e-3 * std::sin(2.1 * place + 2e-3 * tick);
      swing.step();
      swing.see(tip, stiffer * hertz(tip - breath(t)));
    }
    ASSERT_TRUE(swing.believed()) << place;
    EXPECT_NEAR(swing.swing().now, breath(t), 0.2e-3) << place;
  }
  swing.new_place(kSiteB);
  palpate(swing, t, 1.4, breath);
  ASSERT_TRUE(swing.believed());
  EXPECT_NEAR(swing.swing().now, breath(t + 1.4), 0.1e-3);
}

TEST(BreathingEstimatorTest, AReadingBelowZeroWhereAnotherPlaceBeginsDoesNotEndABreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  swing.step();
  swing.see(3e-3, 0.2);
  swing.new_place(kSiteB);
  swing.step();
  swing.see(-3e-3, -0.02);
  palpate(swing, 16, 9, breath);
  ASSERT_TRUE(swing.believed());
  EXPECT_NEAR(swing.surface() + swing.swing().now, breath(25), 0.1e-3);
}

TEST(BreathingEstimatorTest, WhatRelaxesIsNoSoftness) {
  BreathingEstimator swing{kPeriod};
  double past = 0;
  for (int tick = 0; tick < 16'000; ++tick) {
    const double t = kPeriod * tick;
    const double tip = palpating(t);
    const double elastic = hertz(tip - 1e-3 * std::sin(1.6 * t));
    past += kPeriod / 1.2 * (elastic - past);
    swing.step();
    swing.see(tip, std::max(0.0, 1.3 * elastic - 0.3 * past));
  }
  ASSERT_TRUE(swing.believed());
  const auto& shapes = swing.shapes();
  const double at_three = shapes[0] * 3 * std::sqrt(3 / 1.3) + shapes[1] * 9 + shapes[2] * 27;
  EXPECT_NEAR(at_three / hertz(3e-3), 1, 0.06) << "16 % where nothing relaxes";
  EXPECT_NEAR(swing.relaxing()[0] + swing.relaxing()[1], 0.3, 0.1);
}

}  // namespace
}  // namespace palp::coupling
