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

/// [N], of a tip that rests there, as it is told.
double told_force(const BreathingEstimator& swing, double tip) {
  const double xi = 1e3 * (tip - swing.surface() - swing.swing().now);
  const auto& shapes = swing.shapes();
  return xi > 0 ? shapes[0] * xi * std::sqrt(xi / (1 + xi / 10)) + shapes[1] * xi * xi +
                      shapes[2] * xi * xi * xi
                : 0;
}

/// [N], the same 3 mm below the surface.
double told_at_three(const BreathingEstimator& swing) {
  return told_force(swing, swing.surface() + swing.swing().now + 3e-3);
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
      EXPECT_NEAR(found.rate / rate, 1, 0.02) << pace << ' ' << size;
      for (const double ahead : {0.0, 0.1, 0.25}) {
        EXPECT_NEAR(
            swing.surface() + found.after(ahead), breath(16 + ahead), 0.09e-3 + 0.025 * size)
            << pace << " Hz, " << size << " m, " << ahead << " s ahead";
      }
      EXPECT_NEAR(told_at_three(swing) / hertz(3e-3), 1, 0.05) << pace << ' ' << size;
    }
  }
}

/// A breath of which each half is longer or shorter, deeper or shallower than the mean one, by up
/// to so much [-].
class UnevenBreath {
 public:
  UnevenBreath(double size, double pace, double variation)
      : size_{size}, span_{0.5 / pace}, variation_{variation} {}

  double operator()(double t) const {
    double began = 0;
    double from = -size_;
    for (std::uint64_t half = 0;; ++half) {
      const double span = span_ * varied(2 * half);
      const double to = (half % 2 == 0 ? 1 : -1) * size_ * varied(2 * half + 1);
      if (t < began + span) {
        return from + 0.5 * (to - from) * (1 - std::cos(std::numbers::pi * (t - began) / span));
      }
      began += span;
      from = to;
    }
  }

 private:
  [[nodiscard]] double varied(std::uint64_t draw) const {
    return 1 + variation_ * (2 * random_uniform(7, 8, draw) - 1);
  }

  double size_;       ///< [m]
  double span_;       ///< [s], of half a breath in the mean
  double variation_;  ///< [-]
};

/// No sine of one pace and size goes through it.
TEST(BreathingEstimatorTest, FollowsABreathThatIsNeverLikeTheOneBefore) {
  const UnevenBreath breath{1e-3, 0.25, 0.3};
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 6, breath);
  for (int gesture = 2; gesture < 10; ++gesture) {
    const double t = 3.0 * gesture;
    palpate(swing, t, 3, breath);
    ASSERT_TRUE(swing.believed()) << t;
    EXPECT_NEAR(swing.surface() + swing.swing().now, breath(t + 3), 0.35e-3) << t;
    EXPECT_NEAR(told_at_three(swing) / hertz(3e-3), 1, 0.15) << t;
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

TEST(BreathingEstimatorTest, WhatLeavesNoLessThanATissueAtRestIsNoBreath) {
  BreathingEstimator swing{kPeriod};
  swing.rest(1e-8, false);
  palpate(swing, 0, 16, [](double t) { return 1e-3 * std::sin(1.6 * t); });
  EXPECT_FALSE(swing.believed());
}

TEST(BreathingEstimatorTest, AnotherPlaceBreathesWithTheSameBreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  ASSERT_TRUE(swing.believed());
  swing.new_place(kSiteB);
  palpate(swing, 16, 9, [&](double t) { return 2e-3 + breath(t); });
  EXPECT_NEAR(swing.surface() + swing.swing().now, 2e-3 + breath(25), 0.12e-3);
}

/// Of a stay of half a second nothing tells a stiffer tissue from one that has come up; the force
/// says where it is the more so.
TEST(BreathingEstimatorTest, ADragOverManyPlacesDoesNotEndABreath) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  ASSERT_TRUE(swing.believed());
  double t = 16;
  for (int place = 0; place < 40; ++place) {
    swing.new_place({4e-3 * (place + 1), 0});
    const double stiffer = 1 + 0.5 * std::sin(1.3 * place);
    double tip = 0;
    for (int tick = 0; tick < 500; ++tick, t += kPeriod) {
      tip = 3e-3 + 0.5e-3 * std::sin(2.1 * place + 2e-3 * tick);
      swing.step();
      swing.see(tip, stiffer * hertz(tip - breath(t)));
    }
    ASSERT_TRUE(swing.believed()) << place;
    EXPECT_NEAR(told_force(swing, tip), stiffer * hertz(tip - breath(t)), 0.05) << place;
  }
  swing.new_place({-20e-3, 0});
  palpate(swing, t, 9, breath);
  ASSERT_TRUE(swing.believed());
  EXPECT_NEAR(swing.surface() + swing.swing().now, breath(t + 9), 0.1e-3);
}

TEST(BreathingEstimatorTest, WhatWasFoundAtAPlaceIsToldAsTheTipComesBack) {
  const auto breath = [](double t) { return 1e-3 * std::sin(1.6 * t); };
  BreathingEstimator swing{kPeriod};
  palpate(swing, 0, 16, breath);
  const double found = told_at_three(swing);
  swing.new_place(kSiteB);
  for (int tick = 0; tick < 9'000; ++tick) {
    const double t = 16 + kPeriod * tick;
    const double tip = 2e-3 + palpating(kPeriod * tick);
    swing.step();
    swing.see(tip, 2 * hertz(tip - 2e-3 - breath(t)));
  }
  ASSERT_NEAR(told_at_three(swing) / (2 * hertz(3e-3)), 1, 0.15);
  swing.new_place({});
  EXPECT_NEAR(told_at_three(swing) / found, 1, 0.02) << "before it was touched again";
  EXPECT_NEAR(swing.surface(), 0, 0.15e-3) << "the other's is 2 mm lower";
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

TEST(BreathingEstimatorTest, WhatRelaxesIsFoundInPartAndTheQuickStiffnessWhole) {
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
  const double lets_go = swing.relaxing()[0] + swing.relaxing()[1];
  EXPECT_NEAR((1 + lets_go) * told_at_three(swing) / (1.3 * hertz(3e-3)), 1, 0.1);
  EXPECT_GT(lets_go, 0.05) << "a slow breath looks alike";
  EXPECT_LT(lets_go, 0.4);
}

}  // namespace
}  // namespace palp::coupling
