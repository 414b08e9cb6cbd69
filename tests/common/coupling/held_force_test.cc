#include "common/coupling/held_force.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/coupling/contact_model.h"

namespace palp::coupling {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kHeldAt = 3e-3;  // [m]

/// A spring of 300 N/m.
ModelPayload spring() {
  ModelPayload model;
  model.version = 1;
  model.c[0] = 300 * kModelDepthScale;
  model.depth_max = 5e-3;
  return model;
}

double told(HeldForce& held, double position) {
  held.tell(spring());
  return contact_model(held.told()).force(position);
}

/// A tip that rests for `span` [s] on a tissue of `stiffness` [N/m].
void rest(HeldForce& held, double stiffness, double span) {
  for (int tick = 0; tick < static_cast<int>(span / kPeriod); ++tick) {
    held.step(spring(), kHeldAt, stiffness * kHeldAt);
  }
}

TEST(HeldForceTest, AHandIsGivenWhatATipThatRestsMeasures) {
  for (const double stiffness : {180.0, 300.0, 420.0}) {
    HeldForce held{kPeriod};
    rest(held, stiffness, 3);
    EXPECT_NEAR(told(held, kHeldAt) / (stiffness * kHeldAt), 1, 0.01) << stiffness;
    EXPECT_NEAR(held.force() / told(held, kHeldAt), 1, 1e-3) << stiffness;
  }
}

TEST(HeldForceTest, OfATipThatTapsTheFitLearnsAlone) {
  HeldForce held{kPeriod};
  for (int tick = 0; tick < 4000; ++tick) {
    const double t = kPeriod * tick;
    const double position = 2e-3 * (1 - std::cos(2 * std::numbers::pi * t));
    held.step(spring(), position, 420 * position);
    if (t < 1) continue;
    EXPECT_NEAR(told(held, kHeldAt) / (300 * kHeldAt), 1, 0.03) << t;
  }
}

TEST(HeldForceTest, WhatWasHeldIsForgottenAsTheTipGoesOn) {
  HeldForce held{kPeriod};
  rest(held, 400, 3);
  ASSERT_GT(told(held, kHeldAt), 390 * kHeldAt);
  for (int tick = 1; tick <= 100; ++tick) {
    const double position = kHeldAt + 20e-6 * tick;
    held.step(spring(), position, 300 * position);
  }
  EXPECT_NEAR(told(held, kHeldAt) / (300 * kHeldAt), 1, 0.02);
  rest(held, 400, 3);
  held.forget();
  EXPECT_EQ(told(held, kHeldAt), contact_model(spring()).force(kHeldAt)) << "another place";
}

TEST(HeldForceTest, WhatACoarseSensorMayBeOffByIsNotLearned) {
  HeldForce held{kPeriod};
  for (int tick = 0; tick < 3000; ++tick) held.step(spring(), kHeldAt, 300 * kHeldAt + 0.02, 0.025);
  EXPECT_NEAR(held.force(), 300 * kHeldAt, 1e-9);
  for (int tick = 0; tick < 3000; ++tick) held.step(spring(), kHeldAt, 300 * kHeldAt + 0.1, 0.025);
  EXPECT_NEAR(held.force(), 300 * kHeldAt + 0.075, 1e-3);
}

TEST(HeldForceTest, AModelThatIsFarOffIsNotMadeAnother) {
  for (const double stiffness : {0.0, 3000.0}) {
    HeldForce held{kPeriod};
    rest(held, stiffness, 5);
    EXPECT_NEAR(told(held, kHeldAt), (stiffness > 300 ? 1.5 : 0.5) * 300 * kHeldAt, 1e-6);
  }
}

}  // namespace
}  // namespace palp::coupling
