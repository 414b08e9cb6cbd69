#include "common/coupling/direct.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/conventions.h"
#include "tests/support/realtime_guard.h"

namespace palp::coupling {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};
constexpr double kRounding = 1e-12;

Incoming fresh_sample(double position, double force) {
  Incoming incoming;
  incoming.sample.position = position;
  incoming.sample.force = force;
  incoming.fresh = true;
  return incoming;
}

SurgeonInput hand_at(double position, std::span<const Incoming> arrived) {
  return {.state = SiteState::Engaged, .position = position, .arrived = arrived};
}

PatientInput tip_at(double position) {
  PatientInput in;
  in.position = position;
  return in;
}

/// The equation alone.
DirectConfig at_once(DirectConfig config = {}) {
  config.change.slew = config.change.at_once = 1e9;
  return config;
}

/// Force on the hand at `hand` when the patient reported `tip` and `contact`.
double force_for(const DirectConfig& config, double hand, double tip, double contact) {
  DirectSurgeon law{at_once(config)};
  law.begin_epoch(0);
  const std::array arrived{fresh_sample(tip, contact)};
  return law.step(hand_at(hand, arrived), kTick).force;
}

TEST(DirectSurgeonTest, ContactForcePushesTheHandOutOfTheTissue) {
  EXPECT_GT(force_for({}, 3 * kMillimetre, 3 * kMillimetre, 1.0), 0);
}

TEST(DirectSurgeonTest, TipThatLagsBehindAHandMovingInPushesTheHandOut) {
  EXPECT_GT(force_for({}, 3 * kMillimetre, 2 * kMillimetre, 0), 0);
}

TEST(DirectSurgeonTest, TipThatLagsBehindAHandMovingOutPullsTheHandIn) {
  EXPECT_LT(force_for({}, 2 * kMillimetre, 3 * kMillimetre, 0), 0);
}

RC_GTEST_PROP(DirectSurgeonTest, ForceIsEquationOneOfThePaper, ()) {
  const double alpha = *rc::gen::inRange(0, 300) * 0.01;
  const double beta = *rc::gen::inRange(1, 300) * 0.01;
  const double spring = *rc::gen::inRange(0, 2000) * 1.0;
  const double hand = *rc::gen::inRange(-20, 20) * kMillimetre;
  const double tip = *rc::gen::inRange(-20, 20) * kMillimetre;
  const double contact = *rc::gen::inRange(0, 100) * 0.1;
  const DirectConfig config{.force_scale = alpha, .position_scale = beta, .spring = spring};
  const double expected = alpha * contact + spring * (beta * hand - tip);
  RC_ASSERT(std::abs(force_for(config, hand, tip, contact) - expected) < 1e-9);
}

TEST(DirectSurgeonTest, NoForceBeforeTheFirstSampleOfAnEpoch) {
  DirectSurgeon law{{}};
  law.begin_epoch(0);
  EXPECT_EQ(law.step(hand_at(5 * kMillimetre, {}), kTick).force, 0);
  const std::array arrived{fresh_sample(0, 1)};
  EXPECT_GT(law.step(hand_at(5 * kMillimetre, arrived), kTick).force, 0);
  law.begin_epoch(0);
  EXPECT_EQ(law.step(hand_at(5 * kMillimetre, {}), kTick).force, 0);
}

TEST(DirectSurgeonTest, NewestOfSeveralArrivalsCounts) {
  DirectSurgeon law{at_once({.spring = 0})};
  law.begin_epoch(0);
  const std::array arrived{fresh_sample(0, 1), fresh_sample(0, 2), fresh_sample(0, 3)};
  EXPECT_EQ(law.step(hand_at(0, arrived), kTick).force, 3);
}

TEST(DirectSurgeonTest, LateOrRepairedSampleIsNeverUsed) {
  DirectSurgeon law{at_once({.spring = 0})};
  law.begin_epoch(0);
  const std::array first{fresh_sample(0, 1)};
  law.step(hand_at(0, first), kTick);
  Incoming late = fresh_sample(0, 7);
  late.fresh = false;
  Incoming repaired = late;
  repaired.repaired = true;
  const std::array arrived{late, repaired};
  EXPECT_EQ(law.step(hand_at(0, arrived), kTick).force, 1);
}

TEST(DirectSurgeonTest, ForceFadesToZeroInHoldAndReturnsWhenEngaged) {
  DirectSurgeon law{at_once({.spring = 0})};
  law.begin_epoch(0);
  const std::array arrived{fresh_sample(0, 2)};
  EXPECT_EQ(law.step(hand_at(0, arrived), kTick).force, 2);
  SurgeonInput hold = hand_at(0, {});
  hold.state = SiteState::Hold;
  for (int n = 1; n <= 200; ++n) {  // 0.2 s
    EXPECT_NEAR(law.step(hold, kTick).force, 2 * (1 - n / 200.0), kRounding);
  }
  for (int n = 0; n < 100; ++n) EXPECT_NEAR(law.step(hold, kTick).force, 0, kRounding);
  for (int n = 1; n <= 500; ++n) {  // 0.5 s
    EXPECT_NEAR(law.step(hand_at(0, {}), kTick).force, 2 * (n / 500.0), kRounding);
  }
  EXPECT_NEAR(law.step(hand_at(0, {}), kTick).force, 2, kRounding);
}

/// A hand at rest and one that goes out and in, and a peer that says anything.
RC_GTEST_PROP(DirectSurgeonTest, WhatThePeerSaysIsNoKick, ()) {
  constexpr double kStiffest = 650;                         // [N/m]
  const double swing = *rc::gen::element(0.0, 1e-3, 5e-3);  // [m]
  DirectSurgeon law{{}};
  law.begin_epoch(0);
  std::vector<double> forces{0};
  std::vector<double> hands{0};
  for (int i = 1; i <= 300; ++i) {
    const std::array arrived{
        fresh_sample(*rc::gen::element(-0.06, 0.0, 0.06), *rc::gen::element(0.0, 0.2, 5.0, -30.0))};
    hands.push_back(swing * (1 - std::cos(0.05 * i)));
    forces.push_back(law.step(hand_at(hands.back(), arrived), kTick).force);
    const std::size_t from = forces.size() - std::min<std::size_t>(forces.size(), 11);
    const double change = forces.back() - forces[from];
    double way = 0;  // of this window, and of the memory before it
    for (std::size_t k = from - std::min<std::size_t>(from, 20) + 1; k < hands.size(); ++k) {
      way += std::max(0.0, (change > 0 ? 1 : -1) * (hands[k] - hands[k - 1]));
    }
    RC_ASSERT(std::abs(change) <= 0.35 + kStiffest * way + 1e-9);
  }
}

TEST(DirectSurgeonTest, TellsThePatientItsHandAndItsForce) {
  DirectSurgeon law{{}};
  law.begin_epoch(0);
  const std::array arrived{fresh_sample(0.001, 1)};
  SurgeonInput in = hand_at(0.002, arrived);
  in.velocity = 0.05;
  const SurgeonOutput out = law.step(in, kTick);
  EXPECT_EQ(out.to_patient.position, 0.002);
  EXPECT_EQ(out.to_patient.velocity, 0.05);
  EXPECT_EQ(out.to_patient.force, out.force);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(out.to_patient.payload));
}

TEST(DirectPatientTest, StaysWhereTheEpochBeganUntilSomethingIsHeard) {
  DirectPatient law{{}};
  law.begin_epoch(0.004);
  EXPECT_EQ(law.step(tip_at(0.001), kTick).target_position, 0.004);
}

TEST(DirectPatientTest, FollowsTheNewestHandTimesBetaAndKeepsIt) {
  DirectPatient law{{.position_scale = 0.5}};
  law.begin_epoch(0);
  const std::array arrived{fresh_sample(0.002, 0), fresh_sample(0.006, 0)};
  EXPECT_EQ(law.step({.arrived = arrived}, kTick).target_position, 0.003);
  EXPECT_EQ(law.step({}, kTick).target_position, 0.003);
  Incoming late = fresh_sample(0.010, 0);
  late.fresh = false;
  const std::array stale{late};
  EXPECT_EQ(law.step({.arrived = stale}, kTick).target_position, 0.003);
}

TEST(DirectPatientTest, TellsTheSurgeonTipAndMeasuredContactForce) {
  DirectPatient law{{}};
  law.begin_epoch(0);
  PatientInput in = tip_at(0.001);
  in.velocity = -0.02;
  in.contact_force = 1.5;
  const PatientOutput out = law.step(in, kTick);
  EXPECT_EQ(out.to_surgeon.position, 0.001);
  EXPECT_EQ(out.to_surgeon.velocity, -0.02);
  EXPECT_EQ(out.to_surgeon.force, 1.5);
}

RC_GTEST_PROP(DirectTest, CopyOfALawGoesOnLikeTheOriginal, ()) {
  const auto script = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 1000));
  DirectSurgeon surgeon{{}};
  DirectPatient patient{{}};
  surgeon.begin_epoch(0);
  patient.begin_epoch(0);
  DirectSurgeon surgeon_copy = surgeon;
  DirectPatient patient_copy = patient;
  for (std::size_t i = 0; i < script.size(); ++i) {
    if (i == script.size() / 2) {
      surgeon_copy = surgeon;
      patient_copy = patient;
    }
    const double number = script[i] * 1e-5;
    std::vector<Incoming> arrived;
    if (script[i] % 3 != 0) arrived.push_back(fresh_sample(number, std::abs(number) * 100));
    SurgeonInput in = hand_at(-number, arrived);
    in.state = script[i] % 5 == 0 ? SiteState::Hold : SiteState::Engaged;
    RC_ASSERT(surgeon.step(in, kTick).force == surgeon_copy.step(in, kTick).force);
    const PatientInput tip{.position = number, .arrived = arrived};
    RC_ASSERT(patient.step(tip, kTick).target_position ==
              patient_copy.step(tip, kTick).target_position);
  }
}

TEST(DirectTest, BothHalvesAreFitForRealTimeFromTheFirstTick) {
  DirectSurgeon surgeon{{}};
  DirectPatient patient{{}};
  const std::array arrived{fresh_sample(0.001, 1)};
  test::RealtimeGuard guard;
  surgeon.begin_epoch(0);
  patient.begin_epoch(0);
  for (int n = 0; n < 100; ++n) {
    static_cast<void>(surgeon.step(hand_at(0.002, arrived), kTick));
    static_cast<void>(patient.step({.arrived = arrived}, kTick));
  }
  guard.release();
  EXPECT_TRUE(guard.clean()) << guard.first_violation();
}

}  // namespace
}  // namespace palp::coupling
