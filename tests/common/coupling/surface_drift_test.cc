#include "common/coupling/surface_drift.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/coupling/breathing_estimator.h"
#include "common/coupling/contact_model.h"
#include "tests/common/coupling/sensed_tip.h"

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;    // [s]
constexpr double kTip = 3e-3;       // [m]
constexpr double kStiffness = 300;  // [N/m]
constexpr double kTurn = 2 * std::numbers::pi;

ModelPayload spring() {
  return {.version = 1, .c = {kStiffness * kModelDepthScale}, .depth_max = 5e-3};
}

/// [m], where it is told to be after `span` [s].
double told(const SurfaceDrift& drift, double span = 0) {
  const ModelPayload model = drift.moved(spring());
  return model.surface + Swing{model.swing, model.swing_quadrature, model.swing_rate}.after(span);
}

/// A tip at `position` [m], lately of `speed` [m/s], in a spring whose surface is at `surface` [m].
void meet(SurfaceDrift& drift, double position, double speed, double surface) {
  const auto force = [position](double at) { return kStiffness * std::max(0.0, position - at); };
  drift.step(drift.moved(spring()),
             {position, speed, force(surface), force(told(drift)), force(surface) > 0.03});
}

double breath(double at) { return 1.2e-3 * std::sin(kTurn * 0.25 * at); }

TEST(SurfaceDriftTest, ASlowTipTellsWhereTheSurfaceIs) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 12'000; ++tick) {
    const double at = kPeriod * tick;
    meet(drift, kTip, 0, breath(at));
    if (tick < 1000) continue;
    ASSERT_NEAR(told(drift), breath(at), 0.1e-3) << at;
  }
}

TEST(SurfaceDriftTest, ItGoesOnAtAHandThatHearsOfItLate) {
  constexpr double kLate = 0.25;  // [s]
  SurfaceDrift drift{kPeriod};
  double off = 0;
  double stale = 0;
  for (int tick = 0; tick < 12'000; ++tick) {
    const double at = kPeriod * tick;
    meet(drift, kTip, 0, breath(at));
    if (tick < 2000) continue;
    off = std::max(off, std::abs(told(drift, kLate) - breath(at + kLate)));
    stale = std::max(stale, std::abs(breath(at) - breath(at + kLate)));
  }
  EXPECT_LT(off, 0.5 * stale);
}

TEST(SurfaceDriftTest, OfATipThatTapsNothingIsLearned) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) meet(drift, kTip, 5e-3, 0.5e-3);
  EXPECT_NEAR(told(drift), 0, 1e-6);
}

TEST(SurfaceDriftTest, WhereNothingIsFeltTheSurfaceIsNotAboveTheTip) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 2000; ++tick) meet(drift, 1e-3, 0, 5e-3);
  EXPECT_NEAR(told(drift), 1e-3, 0.1e-3);
}

TEST(SurfaceDriftTest, AReadingInTheAirIsNoSurface) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) {
    drift.step(drift.moved(spring()), {-3e-3, 0, tick % 10 == 0 ? 0.05 : 0, 0, false});
  }
  EXPECT_EQ(told(drift), 0);
}

TEST(SurfaceDriftTest, AsTheTipGoesOnItIsForgotten) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) meet(drift, kTip, 0, 1e-3);
  ASSERT_NEAR(told(drift), 1e-3, 0.05e-3);
  for (int tick = 1; tick <= 200; ++tick) meet(drift, kTip - 25e-6 * tick, 25e-3, 0);
  EXPECT_NEAR(told(drift), 0, 0.05e-3);
}

TEST(SurfaceDriftTest, WhatRelaxesIsNoMotionOfTheSurface) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) {
    // A fifth is gone, and the model says so.
    const double given = 0.8 * kStiffness * (kTip - told(drift));
    drift.step(drift.moved(spring()), {kTip, 0, 0.8 * kStiffness * kTip, given, true});
  }
  EXPECT_NEAR(told(drift), 0, 5e-6);
}

TEST(SurfaceDriftTest, FadesAndIsForgottenAtAnotherPlace) {
  SurfaceDrift drift{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) meet(drift, kTip, 0, 1e-3);
  SurfaceDrift elsewhere = drift;
  elsewhere.forget();
  EXPECT_EQ(told(elsewhere), 0);
  for (int tick = 0; tick < 3000; ++tick) drift.fade();
  EXPECT_NEAR(told(drift), 0, 1e-6);
}

double hertz(double depth) { return depth > 0 ? 1897 * depth * std::sqrt(depth) : 0; }

/// A tip that goes 3 mm deep in 0.6 s and rests there, from 1 s on, in a tissue whose surface is at
/// `surface(t)` [m]. @returns the largest error of the force that a hand there is told [N], from
/// `from` to `until` [s].
template <class Surface>
double held_off(const Surface& surface, double from, double until) {
  SensedTip tip;
  double position = -3e-3;
  double off = 0;
  for (int tick = 0; kPeriod * tick < until; ++tick) {
    const double at = kPeriod * tick;
    if (at > 1) position = std::min(3e-3, position + 10e-6);
    const double force = hertz(position - surface(at));
    const double given = tip.meets(position, force);
    if (at > from) off = std::max(off, std::abs(given - force));
  }
  return off;
}

TEST(ContactEstimatorTest, ASurfaceThatSinksIsFollowedBeforeABreathIsKnown) {
  const auto sinks = [](double at) { return at < 2 ? 0 : std::min(2e-3, 2e-3 * (at - 2)); };
  const double force = hertz(3e-3) - hertz(1e-3);
  EXPECT_LT(held_off(sinks, 2.2, 3.5), 0.1 * force);
}

/// Where it is known to stand still, what a resting tip misses is the tissue's, not a swing.
TEST(ContactEstimatorTest, ATissueThatStandsStillIsToldWithoutASwing) {
  SensedTip tip;
  double past = 0;
  double off = 0;
  for (int tick = 0; tick < 12'000; ++tick) {
    const double at = kPeriod * tick;
    const double position = at < 6 ? -3e-3 + 3.5e-3 * (1 - std::cos(kTurn * at)) : 2e-3;
    past += kPeriod / 1.5 * (hertz(position) - past);
    // From 6 s on it comes up besides, as nothing does that is in the model.
    const double rises = at < 6 ? 1 : 1 + 0.03 * (at - 6);
    const double force = rises * std::max(0.0, 1.4 * hertz(position) - 0.4 * past);
    const double given = tip.meets(position, force);
    if (at < 8) continue;
    ASSERT_EQ(tip.told().swing_rate, 0) << at;
    off = std::max(off, std::abs(given / force - 1));
  }
  EXPECT_LT(off, 0.06);
}

TEST(ContactEstimatorTest, NothingIsToldOfATissueWhereATipDeepInItFeelsNothing) {
  SensedTip tip;
  double position = -3e-3;
  const auto go = [&](double by, int ticks, bool there) {
    for (int tick = 0; tick < ticks; ++tick) {
      position += by;
      (void)tip.meets(position, there ? hertz(position) : 0);
    }
  };
  go(0, 1000, true);
  go(10e-6, 600, true);
  go(-10e-6, 600, true);
  ASSERT_GT(contact_model(tip.told()).force(3e-3), 0.2);
  go(30e-6, 200, false);
  EXPECT_EQ(contact_model(tip.told()).force(8e-3), 0);
}

}  // namespace
}  // namespace palp::coupling
