#include "surgeon_site/scripted_operator.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "surgeon_site/script_builder.h"
#include "tests/surgeon_site/fake_session.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;

GestureScript short_script() {
  return ScriptBuilder{300}
      .hold(200ms)
      .move(-3e-3, 500ms)
      .taps(2, 4e-3, 1000ms, 500ms)
      .site(kSiteB)
      .lift(600ms, 200ms)
      .build();
}

/// Lets both live, one millisecond at a time, while `busy` says so, at most `limit`.
Duration run(ScriptedOperator& person,
             FakeSession& session,
             Duration limit,
             const std::function<bool()>& busy) {
  Duration lived{};
  for (; lived < limit && busy(); lived += 1ms) {
    const double before = person.intent().position;
    person.step(1ms);
    EXPECT_LT(std::abs(person.intent().position - before), 0.05e-3) << "the intent jumped";
    session.step(person.pedal_held());
    person.see(session.view());
  }
  return lived;
}

TEST(ScriptedOperatorTest, WaitsForTheSessionBeforeMoving) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-5e-3};
  const auto waits = [&](const char* why) {
    run(person, session, 2s, [] { return true; });
    EXPECT_EQ(person.intent().position, -10e-3) << why;
    EXPECT_FALSE(person.pedal_held()) << why;
  };
  session.state = SiteState::Parked;
  waits("the site is parked");
  session.state = SiteState::Clutched;
  session.peer_state = SiteState::Parked;
  waits("the peer is parked");
  session.peer_state = SiteState::Clutched;
  session.tip_known = false;
  waits("nobody knows where the tip is");
  session.tip_known = true;
  session.link = LinkState::Hold;
  waits("the link holds");
}

TEST(ScriptedOperatorTest, AlignsWithTheTipSlowlyBeforePressing) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-2e-3};
  double fastest = 0;
  run(person, session, 5s, [&] {
    fastest = std::max(fastest, std::abs(person.intent().velocity));
    return !person.pedal_held();
  });
  EXPECT_TRUE(person.pedal_held());
  EXPECT_EQ(person.intent().position, -2e-3);
  EXPECT_GT(fastest, 0.02);
  EXPECT_LE(fastest, 0.03 + 1e-9);
}

TEST(ScriptedOperatorTest, AlignsAgainWhenTheTipMovedMeanwhile) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-2e-3};
  run(person, session, 5s, [&] { return person.intent().position != -2e-3; });
  session.tip = -2.1e-3;
  run(person, session, 5s, [&] { return !person.pedal_held(); });
  EXPECT_EQ(person.intent().position, -2.1e-3);
}

TEST(ScriptedOperatorTest, PerformsTheScriptOnceAndLetsGo) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-2e-3};
  run(person, session, 20s, [&] { return !person.progress().finished; });
  EXPECT_TRUE(person.progress().finished);
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Completed);
  EXPECT_EQ(person.progress().done, 1);
  EXPECT_FALSE(person.pedal_held());
  EXPECT_EQ(session.presses, 1);
  EXPECT_EQ(session.state, SiteState::Clutched);
}

TEST(ScriptedOperatorTest, SurfaceOffsetShiftsTheWholeScript) {
  OperatorConfig config;
  config.surface_offset = 1.7e-3;
  ScriptedOperator person{config, short_script()};
  EXPECT_DOUBLE_EQ(person.intent().position, -8.3e-3);
  FakeSession session{-8.3e-3};
  run(person, session, 20s, [&] { return !person.performing(); });
  run(person, session, 20s, [&] {
    if (person.performing()) {
      EXPECT_DOUBLE_EQ(person.intent().position,
                       person.script().at(person.script_time()).position + 1.7e-3);
    }
    return !person.progress().finished;
  });
}

TEST(ScriptedOperatorTest, ScriptRunsOnInHold) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return !person.performing(); });
  session.state = SiteState::Hold;
  person.see(session.view());
  const Duration before = person.script_time();
  run(person, session, 100ms, [] { return true; });
  EXPECT_EQ(person.script_time() - before, 100ms);
}

TEST(ScriptedOperatorTest, ResumesTheInterruptedPhaseAfterEngagingAgain) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return person.script_time() < 1300ms; });
  ASSERT_EQ(person.progress().phase, 3U);

  session.state = SiteState::Hold;
  run(person, session, 400ms, [] { return true; });
  session.state = SiteState::Retract;
  run(person, session, 1s, [] { return true; });
  EXPECT_FALSE(person.pedal_held());
  EXPECT_EQ(person.script_time(), 700ms) << "the taps begin here";
  session.state = SiteState::Parked;
  run(person, session, 3s, [] { return true; });
  EXPECT_EQ(session.presses, 1);

  session.state = SiteState::Clutched;
  run(person, session, 20s, [&] { return !person.performing(); });
  EXPECT_EQ(session.presses, 2);
  EXPECT_NEAR(person.intent().position, -3e-3, 1e-9);
  run(person, session, 20s, [&] { return !person.progress().finished; });
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Completed);
}

TEST(ScriptedOperatorTest, TakesAPersonsTimeToLetGoOfThePedal) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return !person.performing(); });
  session.state = SiteState::Retract;
  const Duration reaction = run(person, session, 1s, [&] { return person.pedal_held(); });
  EXPECT_GE(reaction, 200ms);
  EXPECT_LE(reaction, 205ms);
}

TEST(ScriptedOperatorTest, StopsAfterALossWhenToldNotToEngageAgain) {
  OperatorConfig config;
  config.engage_again = false;
  ScriptedOperator person{config, short_script()};
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return !person.performing(); });
  session.state = SiteState::Retract;
  run(person, session, 1s, [&] { return !person.progress().finished; });
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Interrupted);
  EXPECT_FALSE(person.pedal_held());
}

TEST(ScriptedOperatorTest, GivesUpAfterSoManyRefusals) {
  OperatorConfig config;
  config.attempts_max = 3;
  ScriptedOperator person{config, short_script()};
  FakeSession session{-10e-3};
  session.willing = false;
  run(person, session, 60s, [&] { return !person.progress().finished; });
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Refused);
  EXPECT_EQ(session.presses, 3);
}

TEST(ScriptedOperatorTest, CountsARefusalOfThePatientSiteToo) {
  OperatorConfig config;
  config.attempts_max = 3;
  ScriptedOperator person{config, short_script()};
  FakeSession session{-10e-3};
  for (int i = 0; i < 3; ++i) {
    run(person, session, 20s, [&] { return session.state != SiteState::Engaged; });
    run(person, session, 500ms, [] { return true; });  // a round trip
    session.state = SiteState::Clutched;
    person.see(session.view());
    run(person, session, 10ms, [] { return true; });
  }
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Refused);
}

TEST(ScriptedOperatorTest, NeverMovesOnAfterAStop) {
  ScriptedOperator person{{}, short_script()};
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return !person.performing(); });
  session.state = SiteState::Stopped;
  run(person, session, 10ms, [] { return true; });
  EXPECT_EQ(person.progress().outcome, ScriptOutcome::Stopped);
  session.state = SiteState::Clutched;
  run(person, session, 10s, [] { return true; });
  EXPECT_FALSE(person.pedal_held());
}

TEST(ScriptedOperatorTest, ProgressNamesThePhase) {
  ScriptedOperator person{{}, short_script()};
  EXPECT_FALSE(person.progress().begun);
  EXPECT_STREQ(person.progress().phase_name.data(), "hold");
  FakeSession session{-10e-3};
  run(person, session, 20s, [&] { return person.script_time() < 1300ms; });
  EXPECT_STREQ(person.progress().phase_name.data(), "taps A");
  EXPECT_NEAR(person.progress().done, 1.3 / 4.5, 1e-9);
}

/// A person who searches, and whose map a test makes up.
struct Searching {
  ScriptedOperator person{{}, ScriptBuilder{300}.hold(100ms).search(6, {}).build()};
  FakeSession session{-10e-3};
  std::uint32_t map{};
  Place next{};
  bool enough{};

  void live(Duration span) {
    for (Duration lived{}; lived < span; lived += 1ms) {
      person.step(1ms);
      session.step(person.pedal_held());
      OperatorView view = session.view();
      view.map = map;
      view.next = next;
      view.enough_touches = enough;
      person.see(view);
    }
  }
  /// Until the person has tapped so often that the next tap asks for the map.
  void three_taps() {
    live(3s);
    const Duration start = person.script_time();
    ASSERT_GT(start, 0ms);
    live(person.script().stretches()[2 + 3 * 3].began_at - start);
  }
};

TEST(ScriptedOperatorTest, ASearchTapsWhereTheMapProposes) {
  Searching one;
  one.three_taps();
  one.map = 3;
  one.next = {30e-3, -5e-3};
  one.live(2s);
  EXPECT_EQ(one.person.intent().place, one.next);
  const Place before = one.next;
  one.next = {1e-3, 2e-3};
  one.map = 4;
  EXPECT_EQ(one.person.intent().place, before) << "a tap is where it is";
  one.live(3500ms);
  EXPECT_EQ(one.person.intent().place, one.next);
}

TEST(ScriptedOperatorTest, ASearchWaitsForTheNewsOfItsLastTapAndNotForEver) {
  Searching one;
  one.map = 3;
  one.next = {30e-3, 0};
  one.three_taps();
  one.live(4s);
  const Duration waits_at = one.person.script().stretches()[2 + 3 * 4].began_at;
  EXPECT_NEAR(seconds(one.person.script_time()), seconds(waits_at), 0.01);
  one.live(2s);
  EXPECT_NEAR(seconds(one.person.script_time()), seconds(waits_at), 0.01);
  one.live(4s);
  EXPECT_GT(one.person.script_time(), waits_at + 500ms);
}

TEST(ScriptedOperatorTest, ASearchEndsWhereTheMapSaysEnough) {
  Searching one;
  one.three_taps();
  const Place last = one.person.intent().place;
  one.map = 3;
  one.enough = true;
  one.live(2ms);
  EXPECT_NEAR(distance(one.person.intent().place, last), 0, 1e-4) << "no jump";
  one.live(1500ms);
  EXPECT_TRUE(one.person.progress().finished);
  EXPECT_EQ(one.person.intent().place, Place{});
}

}  // namespace
}  // namespace palp::surgeon
