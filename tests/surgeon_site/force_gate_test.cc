#include "surgeon_site/force_gate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/coupling/mmt.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using record::NoteCode;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Under a hand that moves `way` [m] in the tick.
ForceRequest engaged(double force, double way = 0) {
  return {.force = force, .way = way, .state = SiteState::Engaged, .pedal_held = true};
}

ForceRequest in(SiteState state, double force, bool pedal_held = true) {
  return {.force = force, .state = state, .pedal_held = pedal_held};
}

/// A gate after a while of contact without force.
ForceGate settled() {
  ForceGate gate{ForceGateConfig{}};
  for (int i = 0; i < 100; ++i) gate.pass(engaged(0), 1ms);
  return gate;
}

/// The same, and the hand has just come so far that it may feel anything.
ForceGate moved(double way = 10e-3) {
  ForceGate gate = settled();
  gate.pass(engaged(0, way), 1ms);
  return gate;
}

TEST(ForceGateTest, LeavesNormalContactAlone) {
  ForceGate gate = settled();
  double before = 0;
  for (int i = 0; i < 3000; ++i) {
    const double force = 2 * std::sin(0.05 * i);  // up to 100 N/s, in tissue of 500 N/m
    const ForceAnswer answer = gate.pass(engaged(force, (force - before) / 500), 1ms);
    before = force;
    ASSERT_EQ(answer.force, force);
    ASSERT_FALSE(answer.acted);
  }
}

TEST(ForceGateTest, ClampsToThePeakAndSaysSoOnce) {
  ForceGate gate = moved();
  const ForceAnswer first = gate.pass(engaged(20), 1ms);
  EXPECT_EQ(first.force, 8.5);
  EXPECT_TRUE(first.acted);
  EXPECT_EQ(first.note, NoteCode::ForceGateClamped);
  EXPECT_EQ(first.detail, 20);
  EXPECT_EQ(gate.pass(engaged(20), 1ms).note, NoteCode::None);
  EXPECT_EQ(gate.pass(engaged(1), 1ms).note, NoteCode::None);
  EXPECT_EQ(gate.pass(engaged(-20, -10e-3), 1ms).note, NoteCode::ForceGateClamped);
  EXPECT_LT(gate.force(), -8.4);
}

TEST(ForceGateTest, LastForceBelowThePeakPasses) {
  EXPECT_EQ(moved().pass(engaged(8.5), 1ms).force, 8.5);
  EXPECT_FALSE(moved().pass(engaged(8.5), 1ms).acted);
}

TEST(ForceGateTest, NotANumberIsZeroAtOnceAndNoted) {
  for (const double bad : {kNan, HUGE_VAL, -HUGE_VAL}) {
    ForceGate gate = moved();
    gate.pass(engaged(2), 1ms);
    const ForceAnswer answer = gate.pass(engaged(bad), 1ms);
    EXPECT_EQ(answer.force, 0);
    EXPECT_EQ(answer.note, NoteCode::NotFinite);
    EXPECT_EQ(gate.pass(engaged(bad), 1ms).note, NoteCode::None);
    gate = settled();
    gate.pass(engaged(bad), 1ms);
    EXPECT_LE(gate.pass(engaged(2), 1ms).force, 0.05 + 1e-12) << "and comes back as a fade";
  }
}

TEST(ForceGateTest, HotMotorsGetTheirContinuousForce) {
  ForceGate gate = settled();
  double force = 0;
  for (int i = 0; i < 120000; ++i) force = gate.pass(engaged(8), 1ms).force;
  EXPECT_NEAR(force, 1.4, 0.02);
}

TEST(ForceGateTest, ContinuousForceIsNeverLimited) {
  ForceGate gate = settled();
  for (int i = 0; i < 40; ++i) gate.pass(engaged(1.4), 1ms);
  for (int i = 0; i < 120000; ++i) ASSERT_EQ(gate.pass(engaged(1.4), 1ms).force, 1.4);
}

TEST(ForceGateTest, HeatNeverExceedsWhatTheMotorsStand) {
  ForceGate gate = settled();
  double heat = 0;
  for (int i = 0; i < 60000; ++i) {
    const double force = gate.pass(engaged(i % 2000 < 1200 ? 8.5 : 0), 1ms).force;
    heat += 1e-3 / 10.0 * (force * force - heat);
    ASSERT_LE(heat, 1.4 * 1.4 + 1e-6);
  }
}

TEST(ForceGateTest, NoForceWithoutPedalOrOutOfContactStates) {
  for (const SiteState state : {SiteState::Parked, SiteState::Clutched, SiteState::Stopped}) {
    ForceGate gate = moved();
    gate.pass(engaged(1), 1ms);
    EXPECT_NEAR(gate.pass(in(state, 1), 1ms).force, 0.96, 1e-12);
    for (int i = 0; i < 25; ++i) gate.pass(in(state, 1), 1ms);
    EXPECT_EQ(gate.force(), 0) << to_string(state);
  }
  ForceGate gate = moved();
  gate.pass(engaged(1), 1ms);
  for (int i = 0; i < 26; ++i) gate.pass(in(SiteState::Engaged, 1, false), 1ms);
  EXPECT_EQ(gate.force(), 0) << "pedal up";
}

TEST(ForceGateTest, RetractAndHoldLeaveTheFadeToTheLaw) {
  for (const SiteState state : {SiteState::Hold, SiteState::Retract}) {
    ForceGate gate = moved();
    gate.pass(engaged(1), 1ms);
    EXPECT_EQ(gate.pass(in(state, 0.99), 1ms).force, 0.99);
  }
}

TEST(ForceGateTest, EmergencyStopIsImmediate) {
  ForceGate gate = moved();
  gate.pass(engaged(8), 1ms);
  ForceRequest stop = in(SiteState::Stopped, 8);
  stop.cut = true;
  EXPECT_EQ(gate.pass(stop, 1ms).force, 0);
}

TEST(ForceGateTest, ALateTickBuysNoBiggerStepOfAFade) {
  ForceGate gate = settled();
  EXPECT_NEAR(gate.pass(engaged(5), {1ms, 100}).force, 0.05, 1e-12);  // as of any tick
  gate = moved();
  gate.pass(engaged(1), 1ms);
  EXPECT_NEAR(gate.pass(in(SiteState::Clutched, 1), {1ms, 100}).force, 0.96, 1e-12);
}

TEST(ForceGateTest, WhatALateTickFindsGrowsSlowlyAndIsLetGoAtOnce) {
  for (const std::int64_t periods : {2, 40}) {
    ForceGate gate = settled();
    for (int i = 0; i < 100; ++i) gate.pass(engaged(1), 1ms);
    const double begin = gate.force();
    ASSERT_EQ(begin, 1);
    EXPECT_LE(gate.pass(engaged(1.8), {1ms, periods}).force, 1.05 + 1e-12) << "no kick";
    for (int i = 1; i < 10; ++i) gate.pass(engaged(1.8), 1ms);
    EXPECT_LE(gate.force(), 1.45 + 1e-12);
    for (int i = 0; i < 20; ++i) gate.pass(engaged(1.8), 1ms);
    EXPECT_EQ(gate.force(), 1.8) << "it catches up";
    EXPECT_EQ(gate.pass(engaged(0.7), {1ms, periods}).force, 0.7)
        << "held up it would give what the law does not pay for";
  }
}

TEST(ForceGateTest, AForceThatFadesGivesASnatchedHandNoMoreThanTheLawCanPay) {
  const coupling::MmtConfig config;
  coupling::MmtSurgeon law{config};
  ForceGate gate = settled();
  Incoming tissue;
  tissue.sample.payload = ModelPayload{.version = 1, .c = {0, 0.06, 0.08}, .depth_max = 5e-3};
  tissue.fresh = true;
  const std::array arrived{tissue};
  double position = -5e-3;  // [m]
  double work = 0;          // [J]
  law.begin_epoch(position);
  const auto move = [&](double speed, SiteState state) {
    position += 1e-3 * speed;
    work += gate.force() * 1e-3 * speed;
    coupling::SurgeonInput given;
    given.state = state;
    given.position = position;
    given.force_applied = gate.force();
    given.round_trip = 50ms;
    given.arrived = arrived;
    const coupling::SurgeonOutput out = law.step(given, 1ms);
    gate.pass({.force = out.force,
               .way = 1e-3 * speed,
               .state = state,
               .pedal_held = state == SiteState::Engaged,
               .fade_max = out.fade_max},
              1ms);
  };
  for (int i = 0; i < 10'000; ++i) move(1e-3, SiteState::Engaged);  // slowly 5 mm in
  ASSERT_GT(gate.force(), 1.5);
  for (int i = 0; i < 500; ++i) move(-0.5, SiteState::Clutched);  // out with the pedal up
  EXPECT_EQ(gate.force(), 0);
  EXPECT_EQ(law.stored(), 0);
  EXPECT_GE(work, -config.tank);
}

RC_GTEST_PROP(ForceGateTest, NoChangeOfStateMovesTheForceByMoreThanHalfANewtonInTenTicks, ()) {
  ForceGate gate = settled();
  const double force = *rc::gen::map(rc::gen::inRange(-8000, 8000), [](int x) { return x * 1e-3; });
  for (int i = 0; i <= 1000; ++i) gate.pass(engaged(force), 1ms);
  std::deque<double> last(10, gate.force());
  for (int i = 0; i < 40; ++i) {
    const auto state = static_cast<SiteState>(*rc::gen::inRange(0, kSiteStateCount));
    const bool pedal = *rc::gen::inRange(0, 4) != 0;
    const int span = *rc::gen::inRange(1, 120);
    for (int k = 0; k < span; ++k) {
      const ForceAnswer answer = gate.pass(in(state, force, pedal), 1ms);
      RC_ASSERT(std::abs(answer.force - last.front()) <= 0.5);
      RC_ASSERT(std::abs(answer.force) <= 8.5);
      last.pop_front();
      last.push_back(answer.force);
    }
  }
}

/// Whatever the law says, and whoever told it so: a hand at rest, or one that lets go.
RC_GTEST_PROP(ForceGateTest, NoForceGrowsByMoreThanHalfANewtonInTenTicksForNoMotion, ()) {
  ForceGate gate = settled();
  const double way = *rc::gen::element(0.0, -0.1e-3);  // [m], a tick: out of the tissue
  gate.pass(engaged(0, way), 1ms);
  std::deque<double> last(10, gate.force());
  for (int i = 0; i < 300; ++i) {
    const double force = *rc::gen::element(0.0, 0.3, 1.0, 3.0, 8.0, 1e9);
    for (int k = *rc::gen::inRange(1, 20); k > 0; --k) {
      const double felt = gate.pass(engaged(force, way), 1ms).force;
      RC_ASSERT(felt - *std::ranges::min_element(last) <= 0.45 + 1e-9);
      RC_ASSERT(felt <= force);
      last.pop_front();
      last.push_back(felt);
    }
  }
}

RC_GTEST_PROP(ForceGateTest, NeverGivesMoreThanTheDeviceCan, ()) {
  ForceGate gate{ForceGateConfig{}};
  for (int i = 0; i < 300; ++i) {
    const double force = *rc::gen::element(0.0, 1.0, -1.0, 9.0, -1e300, 1e300, kNan, HUGE_VAL);
    const auto state = static_cast<SiteState>(*rc::gen::inRange(0, kSiteStateCount));
    const Duration dt = *rc::gen::element<Duration>(1ms, 2ms, 50ms, 10s);
    ForceRequest asked = in(state, force, *rc::gen::arbitrary<bool>());
    asked.way = *rc::gen::element(0.0, 1e-3, -1e-3, 1e300, kNan, HUGE_VAL);
    const ForceAnswer answer = gate.pass(asked, dt);
    RC_ASSERT(std::isfinite(answer.force));
    RC_ASSERT(std::abs(answer.force) <= 8.5);
  }
}

}  // namespace
}  // namespace palp::surgeon
