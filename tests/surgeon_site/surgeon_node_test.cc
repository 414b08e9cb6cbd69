#include "surgeon_site/surgeon_node.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "surgeon_site/script_builder.h"
#include "surgeon_site/simulated_hand.h"
#include "tests/surgeon_site/surgeon_bench.h"

namespace palp::surgeon {
namespace {

using record::NoteCode;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

GestureScript short_script() {
  return ScriptBuilder{kFirmGrip.stiffness}
      .hold(std::chrono::milliseconds{200})
      .move(-3e-3, std::chrono::milliseconds{500})
      .taps(2, 4e-3, std::chrono::milliseconds{1000}, std::chrono::milliseconds{500})
      .press(4e-3, std::chrono::milliseconds{600}, std::chrono::milliseconds{4000})
      .lift(std::chrono::milliseconds{600}, std::chrono::milliseconds{200})
      .build();
}

SimulatedHandConfig firm_hand() {
  SimulatedHandConfig config;
  config.plant.grip = kFirmGrip;
  return config;
}

/// [N] in 10 ms, beyond what the hand's own way of the last 30 does in tissue of 370 N/m. A way of
/// more than 3 mm is no hand's, but an engagement that sets the axis anew.
double worst_step(const Keeper& recorder) {
  const std::vector<SiteTick> ticks = recorder.all<SiteTick>();
  double worst = 0;
  for (std::size_t i = 30; i < ticks.size(); ++i) {
    const double way = std::abs(ticks[i].position - ticks[i - 30].position);
    const double explained = way < 3e-3 ? 370 * way : 0;
    worst = std::max(worst, std::abs(ticks[i].command - ticks[i - 10].command) - explained);
  }
  return worst;
}

bool noted(const Keeper& recorder, NoteCode code) {
  for (const Note& note : recorder.all<Note>()) {
    if (note.code == static_cast<std::uint16_t>(code)) return true;
  }
  return false;
}

TEST(SurgeonNodeTest, AStopOfSomebodyElseLatchesUntilAReset) {
  HeldDevice device;
  Bench bench{device};
  bench.run(500ms);
  ASSERT_EQ(bench.status().state, SiteState::Clutched);
  bench.node().stops().put(1);
  bench.run(2ms);
  EXPECT_EQ(bench.status().state, SiteState::Stopped);
  EXPECT_EQ(bench.status().reason, NoteCode::EmergencyStop);
  bench.run(500ms);
  EXPECT_EQ(bench.status().state, SiteState::Stopped);
  bench.node().commands().put({.emergency_stop = false, .resets = 1});
  bench.run(2ms);
  EXPECT_NE(bench.status().state, SiteState::Stopped);
}

TEST(SurgeonNodeTest, TouchWaitsAsLongAsItIsToldAndForAnotherEpochNotAtAll) {
  HeldDevice device;
  Bench bench{device};
  bench.node().touch_hold().put(40ms);
  bench.run(4s);
  const std::vector<Arrived> waited = bench.recorder.all<Arrived>();
  ASSERT_FALSE(waited.empty());
  EXPECT_EQ(waited.back().at - waited.back().incoming.arrived_at, 40ms);

  device.state.pedal_held = true;
  bench.run(1s, [&] { return bench.status().state != SiteState::Engaged; });
  ASSERT_EQ(bench.status().state, SiteState::Engaged);
  const TimePoint engaged_at = bench.now;
  bench.run(200ms);
  std::size_t heard = 0;
  for (const Arrived& one : bench.recorder.all<Arrived>()) {
    if (one.at <= engaged_at) continue;
    ++heard;
    EXPECT_GE(one.incoming.arrived_at, engaged_at);
  }
  EXPECT_GT(heard, 0U);
}

TEST(SurgeonNodeTest, PalpatesFromBeginningToEnd) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  double force_max = 0;
  double depth_max = 0;
  bench.run(30s, [&] {
    force_max = std::max(force_max, bench.status().force);
    depth_max = std::max(depth_max, bench.patient.position);
    return !hand.finished();
  });
  EXPECT_EQ(hand.progress().outcome, ScriptOutcome::Completed);
  EXPECT_NEAR(force_max, plain_force(4e-3), 0.1);
  EXPECT_NEAR(depth_max, 4e-3, 0.3e-3);
  const auto transitions = bench.recorder.all<Transition>();
  ASSERT_GE(transitions.size(), 3U);
  EXPECT_EQ(transitions[0].to, SiteState::Clutched);
  EXPECT_EQ(transitions[1].to, SiteState::Engaged);
  EXPECT_EQ(transitions[2].to, SiteState::Clutched);
  EXPECT_TRUE(noted(bench.recorder, NoteCode::ScriptPhase));
  EXPECT_TRUE(noted(bench.recorder, NoteCode::SessionBegan));
}

GestureScript dragging_script() {
  ScriptBuilder script{1500};
  script.press(3e-3, 800ms, 300ms).drag(kSiteB, 500ms).lift(500ms, 300ms);
  return script.build();
}

/// How far along x the hand went while it felt something.
double way_under_force(bool hold_in_plane) {
  SimulatedHand hand{firm_hand(), dragging_script()};
  SurgeonConfig config;
  config.hold_in_plane = hold_in_plane;
  Bench bench{hand, config};
  bench.run(30s, [&] { return !hand.finished(); });
  EXPECT_EQ(hand.progress().outcome, ScriptOutcome::Completed);
  double way = 0;
  for (const SiteTick& tick : bench.recorder.all<SiteTick>()) {
    if (tick.force >= 0.1) way = std::max(way, tick.place.x);
  }
  EXPECT_EQ(bench.status().place, kSiteB) << "let go, the hand is where the person is";
  return way;
}

TEST(SurgeonNodeTest, APlaneIsLockedWhileTheHandPressesIfTheDeviceIsTold) {
  EXPECT_EQ(way_under_force(false), kSiteB.x);
  EXPECT_EQ(way_under_force(true), 0);
}

TEST(SurgeonNodeTest, LawIsToldTheForceThatWasApplied) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  bench.run(30s, [&] { return !hand.finished(); });
  double before = 0;
  for (const SiteTick& tick : bench.recorder.all<SiteTick>()) {
    ASSERT_EQ(tick.force, before);
    before = tick.command;
  }
}

TEST(SurgeonNodeTest, EngagementMovesNothingHoweverFarTheHandIsFromTheTip) {
  HeldDevice device;
  device.state.position = 15e-3;
  Bench bench{device};
  bench.run(1s);
  ASSERT_EQ(bench.status().state, SiteState::Clutched);
  device.state.pedal_held = true;
  bench.run(1s);
  EXPECT_EQ(bench.status().state, SiteState::Engaged);
  EXPECT_DOUBLE_EQ(bench.status().offset, 25e-3);
  EXPECT_DOUBLE_EQ(bench.status().position, -10e-3);
  EXPECT_DOUBLE_EQ(bench.patient.position, -10e-3);
  EXPECT_EQ(device.force_applied, 0);
}

TEST(SurgeonNodeTest, SamplesSentBeforeTheEngagementCauseNoForce) {
  HeldDevice device;
  Bench bench{device};
  bench.up.delay = bench.down.delay = 20ms;
  bench.patient.follows = false;
  bench.patient.position = 3e-3;  // in contact: its samples carry force
  bench.run(1s);
  device.state.pedal_held = true;
  device.state.position += 5e-3;
  bench.run(1s);
  ASSERT_EQ(bench.status().state, SiteState::Engaged);
  for (const SiteTick& tick : bench.recorder.all<SiteTick>()) {
    ASSERT_EQ(tick.command, 0);
  }
}

TEST(SurgeonNodeTest, NoForceWhileThePedalIsUp) {
  HeldDevice device;
  Bench bench{device};
  bench.run(1s);
  device.state.pedal_held = true;
  bench.run(500ms);
  device.state.position = 3e-3 + bench.status().offset;
  bench.run(500ms);
  ASSERT_GT(device.force_applied, 0.1);
  device.state.pedal_held = false;
  bench.run(1ms);
  EXPECT_EQ(bench.status().state, SiteState::Clutched);
  bench.run(100ms);
  EXPECT_EQ(device.force_applied, 0);
}

TEST(SurgeonNodeTest, PatientKilledInAPressGoesHoldThenRetractThenEngagesAgain) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  bench.run(30s,
            [&] { return std::string_view{hand.progress().phase_name.data()} != "press 4 mm A"; });
  bench.run(1s);
  ASSERT_EQ(bench.status().state, SiteState::Engaged);
  ASSERT_GT(bench.status().force, 0.3);

  const TimePoint killed_at = bench.now;
  bench.patient_lives = false;
  bench.run(99ms);
  EXPECT_EQ(bench.status().state, SiteState::Engaged);
  bench.run(4s);
  bench.restart_patient(2);
  bench.run(30s, [&] { return !hand.finished(); });
  EXPECT_EQ(hand.progress().outcome, ScriptOutcome::Completed);
  EXPECT_LE(worst_step(bench.recorder), 0.5);

  std::vector<SiteState> states;
  TimePoint held_at{};
  TimePoint retracted_at{};
  for (const Transition& transition : bench.recorder.all<Transition>()) {
    if (transition.at < killed_at) continue;
    states.push_back(transition.to);
    if (transition.to == SiteState::Hold) held_at = transition.at;
    if (transition.to == SiteState::Retract && retracted_at == TimePoint{}) {
      retracted_at = transition.at;
    }
  }
  ASSERT_GE(states.size(), 5U);
  EXPECT_EQ(states[0], SiteState::Hold);
  EXPECT_EQ(states[1], SiteState::Retract);
  EXPECT_EQ(states[2], SiteState::Parked);
  EXPECT_EQ(states[3], SiteState::Clutched);
  EXPECT_EQ(states[4], SiteState::Engaged);
  EXPECT_NEAR(seconds(held_at - killed_at), 0.1, 0.003);
  EXPECT_NEAR(seconds(retracted_at - killed_at), 2.0, 0.003);
}

TEST(SurgeonNodeTest, RestartWithinAHoldIsNoWayBackToTheOldSession) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  bench.run(30s,
            [&] { return std::string_view{hand.progress().phase_name.data()} != "press 4 mm A"; });
  bench.run(1s);
  bench.patient_lives = false;
  bench.run(200ms);
  ASSERT_EQ(bench.status().state, SiteState::Hold);
  bench.restart_patient(2);
  bench.run(1ms);
  EXPECT_EQ(bench.status().state, SiteState::Retract);
  EXPECT_EQ(bench.status().reason, NoteCode::SessionBegan);
  EXPECT_FALSE(bench.status().tip_known);
  EXPECT_LE(worst_step(bench.recorder), 0.5);
}

TEST(SurgeonNodeTest, ShortGapHoldsAndComesBackWithoutAJump) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  bench.run(30s,
            [&] { return std::string_view{hand.progress().phase_name.data()} != "press 4 mm A"; });
  bench.run(1s);
  bench.down.cut = true;
  bench.run(400ms);
  EXPECT_EQ(bench.status().state, SiteState::Hold);
  EXPECT_NEAR(bench.status().force, 0, 1e-9);
  bench.down.cut = false;
  bench.run(1s);
  EXPECT_EQ(bench.status().state, SiteState::Engaged);
  EXPECT_GT(bench.status().force, 0.3);
  EXPECT_LE(worst_step(bench.recorder), 0.5);
}

TEST(SurgeonNodeTest, UsersStopIsImmediateAndLatched) {
  HeldDevice device;
  Bench bench{device};
  bench.run(1s);
  device.state.pedal_held = true;
  bench.run(500ms);
  device.state.position = 3e-3 + bench.status().offset;
  bench.run(500ms);
  ASSERT_GT(device.force_applied, 0.1);
  bench.node().commands().put({.emergency_stop = true, .resets = 0});
  bench.run(1ms);
  EXPECT_EQ(device.force_applied, 0);
  EXPECT_EQ(bench.status().state, SiteState::Stopped);
  bench.node().commands().put({.emergency_stop = false, .resets = 0});
  bench.run(1s);
  EXPECT_EQ(bench.status().state, SiteState::Stopped);
  bench.node().commands().put({.emergency_stop = false, .resets = 1});
  bench.run(1s);
  EXPECT_EQ(bench.status().state, SiteState::Clutched);
}

TEST(SurgeonNodeTest, DeviceWithoutNumbersStopsTheSite) {
  HeldDevice device;
  Bench bench{device};
  bench.run(1s);
  device.state.pedal_held = true;
  bench.run(500ms);
  device.state.position = std::numeric_limits<double>::quiet_NaN();
  bench.run(10ms);
  EXPECT_EQ(bench.status().state, SiteState::Stopped);
  EXPECT_EQ(bench.status().reason, NoteCode::DeviceFault);
  EXPECT_TRUE(std::isfinite(bench.status().position));
  EXPECT_EQ(device.force_applied, 0);
  int notes = 0;
  for (const Note& note : bench.recorder.all<Note>()) {
    notes += note.code == static_cast<std::uint16_t>(NoteCode::NotFinite);
  }
  EXPECT_EQ(notes, 1);
}

TEST(SurgeonNodeTest, LongRoundTripIsRefusedAndShown) {
  SurgeonConfig config;
  config.supervisor.round_trip_max_to_engage = 20ms;
  HeldDevice device;
  Bench bench{device, config};
  bench.up.delay = bench.down.delay = 12ms;
  bench.run(1s);
  device.state.pedal_held = true;
  bench.run(1s);
  EXPECT_EQ(bench.status().state, SiteState::Clutched);
  EXPECT_EQ(bench.status().refused, NoteCode::RoundTripTooLong);
}

TEST(SurgeonNodeTest, RecordsEveryTickEveryArrivalAndTenStatusesASecond) {
  HeldDevice device;
  Bench bench{device};
  bench.run(2s);
  EXPECT_EQ(bench.recorder.all<SiteTick>().size(), 2000U);
  EXPECT_EQ(bench.recorder.all<LinkStatus>().size(), 20U);
  EXPECT_EQ(bench.recorder.all<Arrived>().size(), 1999U);
  EXPECT_EQ(bench.status().ticks, 2000U);
  EXPECT_EQ(bench.status().records, bench.recorder.kept.size());
}

TEST(SurgeonNodeTest, EachDepthIsRecordedOnce) {
  HeldDevice device;
  Bench bench{device};
  bench.run(100ms);
  bench.patient.report.depth.number = 1;
  bench.patient.report.depth.depth = 5e-3;
  bench.run(100ms);
  bench.patient.report.depth.number = 2;
  bench.run(100ms);
  const auto depths = bench.recorder.all<DepthArrived>();
  ASSERT_EQ(depths.size(), 2U);
  EXPECT_EQ(depths[0].report.depth, 5e-3);
  EXPECT_EQ(bench.status().depth.number, 2U);
}

TEST(SurgeonNodeTest, AForceFadesNoFasterBecauseTheProcessSlept) {
  SimulatedHand hand{firm_hand(), short_script()};
  Bench bench{hand};
  bench.run(30s, [&] { return bench.status().force < 0.3; });
  const double before = bench.status().force;
  bench.now += 40s;  // longer than any session lives
  bench.run(1ms);
  EXPECT_NE(bench.status().state, SiteState::Engaged);
  EXPECT_GT(bench.status().force, 0.9 * before);
}

TEST(SurgeonNodeTest, ASleepBeyondTheLimitEndsTheEngagementAndAShorterOneDoesNot) {
  for (const Duration sleep : {Duration{1ms}, Duration{49ms}, Duration{51ms}, Duration{2s}}) {
    SimulatedHand hand{firm_hand(), short_script()};
    Bench bench{hand};
    bench.run(30s, [&] { return bench.status().force < 0.3; });
    const double before = bench.status().force;
    bench.now += sleep - 1ms;
    bench.run(1ms);
    const bool over = sleep > kLateMax;
    EXPECT_EQ(bench.status().state == SiteState::Engaged, !over) << seconds(sleep);
    EXPECT_EQ(bench.status().reason == NoteCode::TickLate, over) << seconds(sleep);
    EXPECT_NEAR(bench.status().force, before, 0.1) << "it goes on from what was held";
    if (!over) continue;
    bench.run(1s, [&] { return bench.status().force > 0; });
    EXPECT_EQ(bench.status().force, 0) << "and fades";
  }
}

TEST(SurgeonNodeTest, IsHeardWhateverItsLawComputes) {
  HeldDevice device;
  Bench bench{device};
  bench.run(100ms);
  device.state.position = 1e6;  // [m]
  bench.run(100ms);
  EXPECT_EQ(bench.status().link.unsent, 0U);
  EXPECT_EQ(bench.status().samples_limited, 100U);
}

TEST(SurgeonNodeTest, LateTickCountsThePeriodsMissed) {
  HeldDevice device;
  Bench bench{device};
  bench.run(10ms);
  bench.now += 4ms;
  bench.run(1ms);
  EXPECT_EQ(bench.status().ticks, 11U);
  EXPECT_EQ(bench.status().ticks_missed, 4U);
}

TEST(SurgeonNodeTest, ShowsTheDeviceWhatTheOperatorSees) {
  HeldDevice device;
  Bench bench{device};
  bench.run(1s);
  EXPECT_EQ(device.shown.state, SiteState::Clutched);
  EXPECT_EQ(device.shown.peer_state, SiteState::Clutched);
  EXPECT_EQ(device.shown.link, LinkState::Live);
  EXPECT_TRUE(device.shown.tip_known);
  EXPECT_DOUBLE_EQ(device.shown.tip_position, -10e-3);
}

}  // namespace
}  // namespace palp::surgeon
