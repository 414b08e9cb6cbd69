#include "patient_site/motion_gate.h"

#include <cmath>
#include <deque>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace palp::patient {
namespace {

using record::NoteCode;
constexpr Duration kTick = std::chrono::milliseconds{1};

/// Its sensor has no pole to speak of: the tip is felt where it is.
MotionGate gate_at(double tip, const MotionGateConfig& config = {}) {
  MotionGate gate{config, {.stage = {}, .sensor = {.pole = 1e5, .lag = 0}}};
  gate.begin(tip, {});
  return gate;
}

MotionRequest engaged(double position, double tip = 0, double force = 0) {
  return {SiteState::Engaged, position, {}, tip, force};
}

/// Felt for long enough to be believed.
void touch(MotionGate& gate, double tip, double force) {
  for (int i = 0; i < 100; ++i) gate.feel(tip, force);
}
void let_go(MotionGate& gate, double tip) { touch(gate, tip, 0); }

TEST(MotionGateTest, FeelsTheTipBehindTheSensorsPoleAsItDoesTheForce) {
  // The tip steps in and the force, already behind the pole, is felt at once: the surface is sought
  // where the filtered tip was.
  const auto surface_with = [](double pole) {
    MotionGate gate{{}, {.stage = {}, .sensor = {.pole = pole}}};
    gate.begin(0, {});
    for (int i = 0; i < 8; ++i) gate.feel(2e-3, 0.2);
    return gate.surface().value();
  };
  EXPECT_LT(surface_with(20), surface_with(1e5) - 0.2e-3);
}

TEST(MotionGateTest, FollowsSlowMotionExactly) {
  MotionGate gate = gate_at(-10e-3);
  for (int i = 0; i < 2000; ++i) {
    const double asked = -10e-3 + 3e-3 * (1 - std::cos(i * 1e-3 * 6.28));
    const MotionAnswer answer = gate.pass(engaged(asked), kTick);
    EXPECT_EQ(answer.position, asked);
    EXPECT_FALSE(answer.acted);
  }
}

TEST(MotionGateTest, NeverExceedsSpeedAndAccelerationWhateverIsAsked) {
  rc::check([] {
    MotionGate gate = gate_at(0);
    double before = 0;
    double speed_before = 0;
    for (int i = 0; i < 60; ++i) {
      const double asked = *rc::gen::inRange(-60'000, 60'000) * 1e-6;
      const double position = gate.pass(engaged(asked), kTick).position;
      const double speed = (position - before) / 1e-3;
      RC_ASSERT(std::abs(speed) <= 0.15 + 1e-9);
      const bool small_step = std::abs(position - before) <= 50e-6 + 1e-12;
      RC_ASSERT(small_step || std::abs(speed - speed_before) <= 8e-3 + 1e-9);
      RC_ASSERT(std::abs(position) <= 50e-3);
      before = position;
      speed_before = speed;
    }
  });
}

TEST(MotionGateTest, ALateTickBuysNoBiggerStep) {
  for (const SiteState state : {SiteState::Engaged, SiteState::Retract}) {
    const auto step_after = [&](std::int64_t periods) {
      MotionGate gate = gate_at(0);
      touch(gate, 0, 0.2);
      const MotionRequest request{state, 40e-3, {}, 0, 0};
      return std::abs(gate.pass(request, {kTick, periods}).position);
    };
    EXPECT_GT(step_after(1), 0);
    for (const std::int64_t periods : {2, 10, 500}) {
      EXPECT_EQ(step_after(periods), step_after(1)) << to_string(state);
    }
  }
}

TEST(MotionGateTest, ATargetWithinTheSpeedStillWaitsForTheAcceleration) {
  MotionGate gate = gate_at(0);
  // 0.14 m/s from rest; 8 m/s^2 give 8 mm/s in the first tick.
  EXPECT_NEAR(gate.pass(engaged(140e-6), kTick).position, 8e-6, 1e-9);
}

TEST(MotionGateTest, ReachesAFarTargetAndStaysThere) {
  MotionGate gate = gate_at(0);
  double position = 0;
  for (int i = 0; i < 500; ++i) position = gate.pass(engaged(20e-3), kTick).position;
  EXPECT_EQ(position, 20e-3);
}

TEST(MotionGateTest, KeepsTheTravelBoxAndSaysSoOnce) {
  MotionGate gate = gate_at(49.9e-3);
  int notes = 0;
  for (int i = 0; i < 200; ++i) {
    const MotionAnswer answer = gate.pass(engaged(60e-3), kTick);
    EXPECT_LE(answer.position, 50e-3);
    EXPECT_TRUE(answer.acted);
    notes += answer.note == NoteCode::MotionGateLimited ? 1 : 0;
  }
  EXPECT_EQ(notes, 1);
}

TEST(MotionGateTest, LearnsTheSurfaceFromTheFirstContact) {
  MotionGate gate = gate_at(0);
  EXPECT_FALSE(gate.surface());
  touch(gate, 1.4e-3, 0.1);  // Hertz with 1897 N/m^1.5: 0.1 N at 1.41 mm, half of it at 0.89 mm
  ASSERT_TRUE(gate.surface());
  EXPECT_NEAR(*gate.surface(), 0.3e-3, 0.3e-3);
  const double learned = *gate.surface();
  touch(gate, 4e-3, 0.5);
  EXPECT_EQ(*gate.surface(), learned);
}

TEST(MotionGateTest, ASingleNoisySampleIsNoContact) {
  MotionGate gate = gate_at(0);
  for (int i = 0; i < 100; ++i) gate.feel(0, i % 40 == 0 ? 0.15 : 0);
  EXPECT_FALSE(gate.surface());
}

TEST(MotionGateTest, IsSlowNearAKnownSurface) {
  MotionGate gate = gate_at(0);
  touch(gate, 0, 0.1);
  let_go(gate, 0);
  double before = 0;
  double fastest = 0;
  for (int i = 0; i < 50; ++i) {
    const double position = gate.pass(engaged(6e-3, before), kTick).position;
    fastest = std::max(fastest, (position - before) / 1e-3);
    before = position;
  }
  EXPECT_LE(fastest, 0.05 + 1e-9);
  EXPECT_GT(fastest, 0.04);
}

TEST(MotionGateTest, WhereNoSurfaceIsKnownItIsAsSlowInwardsAsNearOne) {
  const auto speed_after = [](double target) {
    MotionGate gate = gate_at(0);
    double before = 0;
    double speed = 0;
    for (int i = 0; i < 60; ++i) {
      const double position = gate.pass(engaged(target), kTick).position;
      speed = (position - before) / 1e-3;
      before = position;
    }
    return speed;
  };
  EXPECT_NEAR(speed_after(40e-3), MotionGateConfig{}.speed_near, 1e-6);
  EXPECT_NEAR(speed_after(-40e-3), -MotionGateConfig{}.speed_max, 1e-6);
}

TEST(MotionGateTest, GoesNoDeeperThanItsDepth) {
  MotionGate gate = gate_at(0);
  touch(gate, 0, 0.1);
  for (int i = 0; i < 1000; ++i) {
    gate.feel(gate.command(), 0.1);
    (void)gate.pass(engaged(20e-3, gate.command()), kTick);
  }
  EXPECT_NEAR(gate.command(), *gate.surface() + 8e-3, 1e-9);
}

TEST(MotionGateTest, WalksAwayFromTooMuchForceFasterTheHigherItIs) {
  for (const auto& [force, speed] :
       {std::pair{3.001, 0.03}, std::pair{3.25, 0.06}, std::pair{4.9, 0.09}}) {
    MotionGate gate = gate_at(5e-3);
    const MotionAnswer answer = gate.pass(engaged(6e-3, 5e-3, force), kTick);
    EXPECT_NEAR(answer.position, 5e-3 - speed * 1e-3, 2e-6) << force;
    EXPECT_EQ(answer.note, NoteCode::ForceRetreat);
    EXPECT_EQ(gate.pass(engaged(6e-3, 5e-3, force), kTick).note, NoteCode::None) << "once";
  }
  MotionGate gate = gate_at(5e-3);
  EXPECT_GT(gate.pass(engaged(5.01e-3, 5e-3, 3.0), kTick).position, 5e-3) << "3 N is allowed";
}

/// A law asks for 8 mm in tissue of 1.5 N/mm, behind a stage and a sensor that lag by 20 ms.
TEST(MotionGateTest, DoesNotHammerAtItsLimitOnStiffTissue) {
  MotionGate gate = gate_at(0);
  std::deque<double> stage(20, 0.0);
  int retreats = 0;
  double last = 0;
  double highest = 0;
  bool retreating = false;
  for (int tick = 0; tick < 6000; ++tick) {
    const double tip = stage.front();
    const double force = 1500 * std::max(0.0, tip);
    gate.feel(tip, force);
    const double command = gate.pass(engaged(8e-3, tip, force), kTick).position;
    retreats += command < last && !retreating ? 1 : 0;
    retreating = command < last;
    if (tick > 500) highest = std::max(highest, force);
    last = command;
    stage.push_back(command);
    stage.pop_front();
  }
  EXPECT_EQ(retreats, 1);
  EXPECT_LE(highest, 3);
  EXPECT_NEAR(1500 * stage.front(), 2.7, 0.05) << "it comes to rest below the limit";
}

TEST(MotionGateTest, RetreatsInEveryStateButStopped) {
  for (const SiteState state :
       {SiteState::Clutched, SiteState::Hold, SiteState::Retract, SiteState::Parked}) {
    MotionGate gate = gate_at(5e-3);
    EXPECT_LT(gate.pass({state, 9e-3, {}, 5e-3, 3.5}, kTick).position, 5e-3);
  }
}

TEST(MotionGateTest, HoldsOnWhatIsNoNumber) {
  MotionGate gate = gate_at(1e-3);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const MotionAnswer answer = gate.pass(engaged(bad), kTick);
    EXPECT_EQ(answer.position, 1e-3);
    EXPECT_TRUE(answer.acted);
  }
  EXPECT_EQ(gate.pass(engaged(1.01e-3), kTick).position, 1.01e-3);
}

TEST(MotionGateTest, OnlyEngagedFollows) {
  for (const SiteState state : {SiteState::Parked, SiteState::Clutched, SiteState::Hold}) {
    MotionGate gate = gate_at(1e-3);
    const MotionAnswer answer = gate.pass({state, 5e-3, {10e-3, 0}, 1e-3, 0}, kTick);
    EXPECT_EQ(answer.position, 1e-3) << to_string(state);
    EXPECT_EQ(answer.place, kSiteA);
    EXPECT_FALSE(answer.halt);
  }
  MotionGate gate = gate_at(1e-3);
  EXPECT_TRUE(gate.pass({SiteState::Stopped, 5e-3, {}, 2e-3, 0}, kTick).halt);
}

TEST(MotionGateTest, RetractsSlowlyToTwoMillimetreClear) {
  MotionGate gate = gate_at(3e-3);
  touch(gate, 0, 0.1);
  EXPECT_FALSE(gate.retracted(3e-3));
  double before = gate.command();
  for (int i = 0; i < 2000; ++i) {
    const double position = gate.pass({SiteState::Retract, 9e-3, {}, before, 0.2}, kTick).position;
    EXPECT_LE(position, before);
    EXPECT_LE(before - position, 5e-6 + 1e-12);
    before = position;
  }
  EXPECT_NEAR(before, *gate.surface() - 2e-3, 60e-6);
  EXPECT_TRUE(gate.retracted(before));
}

TEST(MotionGateTest, ALostLinkTakesTheTipOutOfWhatItCreptIntoUnnoticed) {
  MotionGate gate = gate_at(0);
  for (int i = 0; i < 60'000; ++i) gate.feel(0, 0.02 * std::exp(i / 12e3));  // to 3 N in a minute
  ASSERT_FALSE(gate.surface()) << "too slow for a contact";
  double before = 0;
  for (int i = 0; i < 100; ++i) {
    const double position = gate.pass({SiteState::Retract, 0, {}, before, 2}, kTick).position;
    EXPECT_NEAR(position - before, -5e-6, 1e-9);
    before = position;
  }
  let_go(gate, before);
  EXPECT_EQ(gate.pass({SiteState::Retract, 0, {}, before, 0}, kTick).position, before);
}

TEST(MotionGateTest, OneWrongSampleOfTheSensorIsNoSurfaceForGood) {
  for (const double wrong : {0.5, 1.0, 2.9}) {
    MotionGate gate = gate_at(-10e-3);
    let_go(gate, -10e-3);
    gate.feel(-10e-3, wrong);
    for (int i = 0; i < 60; ++i) gate.feel(-10e-3, 0);
    EXPECT_FALSE(gate.surface()) << wrong;
    for (int i = 0; i < 1000; ++i) (void)gate.pass(engaged(5e-3, gate.command()), kTick);
    EXPECT_NEAR(gate.command(), 5e-3, 1e-9) << wrong;
  }
  MotionGate gate = gate_at(0);
  for (int i = 0; i < 20; ++i) gate.feel(0, 0.5);
  for (int i = 0; i < 60; ++i) gate.feel(-0.5e-3, 0);
  EXPECT_TRUE(gate.surface()) << "a short touch that was left again";
}

TEST(MotionGateTest, ATipThatNeverTouchedIsClearAlready) {
  MotionGate gate = gate_at(-10e-3);
  EXPECT_TRUE(gate.retracted(-10e-3));
  EXPECT_EQ(gate.pass({SiteState::Retract, 0, {}, -10e-3, 0}, kTick).position, -10e-3);
}

TEST(MotionGateTest, CatchesUpSlowlyAfterAGap) {
  MotionGate gate = gate_at(-10e-3);
  gate.resynchronise();
  double before = -10e-3;
  while (before < -5.6e-3) {
    const double position = gate.pass(engaged(-5e-3), kTick).position;
    EXPECT_LE(position - before, 30e-6 + 1e-12);
    ASSERT_GT(position, before);
    before = position;
  }
  for (int i = 0; i < 100; ++i) (void)gate.pass(engaged(-5e-3), kTick);
  before = gate.command();
  double fastest = 0;
  for (int i = 0; i < 100; ++i) {
    const double position = gate.pass(engaged(-15e-3), kTick).position;
    fastest = std::max(fastest, before - position);
    before = position;
  }
  EXPECT_GT(fastest, 100e-6) << "caught up, the speed of the air holds again";
}

/// Asks for `place` until the stage would stand there, half a second at most.
MotionAnswer go_to(MotionGate& gate, const Place& place, double tip, double force = 0) {
  MotionAnswer answer;
  for (int i = 0; i < 500; ++i) {
    answer = gate.pass({SiteState::Engaged, tip, place, tip, force}, kTick);
    if (answer.place == place) break;
  }
  return answer;
}

TEST(MotionGateTest, GoesToAnyPlaceOfItsTravelInTheAir) {
  MotionGate gate = gate_at(-10e-3);
  EXPECT_EQ(go_to(gate, {10e-3, -4e-3}, -10e-3).place, (Place{10e-3, -4e-3}));
  EXPECT_EQ(gate.pass({SiteState::Engaged, -10e-3, {10e-3, -4e-3}, -10e-3, 0}, kTick).place_refused,
            NoteCode::None);
}

TEST(MotionGateTest, KeepsItsPlaceWhileNotEngaged) {
  MotionGate gate = gate_at(-10e-3);
  for (const SiteState state : {SiteState::Hold, SiteState::Retract, SiteState::Stopped}) {
    EXPECT_EQ(gate.pass({state, -10e-3, kSiteB, -10e-3, 0}, kTick).place, kSiteA);
  }
}

TEST(MotionGateTest, APlaceThatIsNoNumberIsNotedOnceAndNotFollowed) {
  MotionGate gate = gate_at(-10e-3);
  const MotionRequest request{SiteState::Engaged, -10e-3, {std::nan(""), 0}, -10e-3, 0};
  MotionAnswer answer = gate.pass(request, kTick);
  EXPECT_EQ(answer.place, kSiteA);
  EXPECT_EQ(answer.place_note, NoteCode::NotFinite);
  answer = gate.pass(request, kTick);
  EXPECT_EQ(answer.place_note, NoteCode::None);
  EXPECT_EQ(answer.place_refused, NoteCode::NotFinite);
}

TEST(MotionGateTest, DragsSlowlyWhatIsPressed) {
  MotionGate gate = gate_at(2e-3);
  touch(gate, 2e-3, 0.3);
  Place before = kSiteA;
  for (int i = 0; i < 1200; ++i) {
    const MotionAnswer answer = gate.pass({SiteState::Engaged, 2e-3, kSiteB, 2e-3, 0.3}, kTick);
    ASSERT_LE(distance(answer.place, before), 20e-6 + 1e-12);
    before = answer.place;
  }
  EXPECT_EQ(before, kSiteB);
}

TEST(MotionGateTest, AStageThatCannotDragKeepsItsPlaceAndSaysSo) {
  MotionGate gate = gate_at(2e-3, {.plane = {.drag_speed = 0}});
  touch(gate, 2e-3, 0.3);
  const MotionAnswer first = gate.pass({SiteState::Engaged, 2e-3, kSiteB, 2e-3, 0.3}, kTick);
  EXPECT_EQ(first.place, kSiteA);
  EXPECT_EQ(first.place_note, NoteCode::DragRefused);
  EXPECT_EQ(go_to(gate, kSiteB, 2e-3, 0.3).place, kSiteA);
  let_go(gate, -5e-3);
  const MotionAnswer out = go_to(gate, kSiteB, -5e-3);
  EXPECT_EQ(out.place, kSiteB);
  EXPECT_EQ(out.place_refused, NoteCode::None);
}

TEST(MotionGateTest, AStoppedStageThatWasMovedSetsOutFromWhereItStands) {
  MotionGate gate = gate_at(-5e-3);
  const Place moved{30e-3, -10e-3};
  const MotionAnswer stopped = gate.pass({.state = SiteState::Stopped,
                                          .position = -5e-3,
                                          .place = kSiteA,
                                          .tip = -5e-3,
                                          .contact_force = 0,
                                          .stands = moved},
                                         kTick);
  EXPECT_TRUE(stopped.halt);
  const MotionAnswer parked = gate.pass({SiteState::Parked, -5e-3, kSiteA, -5e-3, 0, moved}, kTick);
  EXPECT_FALSE(parked.halt);
  EXPECT_EQ(parked.place, moved);
}

TEST(MotionGateTest, ADragKeepsTheSurfaceAndTheDepthAllowed) {
  MotionGate gate = gate_at(0);
  touch(gate, 0, 0.1);
  const double surface = *gate.surface();
  for (int i = 0; i < 1500; ++i) {
    // Softer tissue at the same depth: no reason to believe that the surface sank.
    gate.feel(6e-3, 0.15);
    const MotionAnswer answer = gate.pass({SiteState::Engaged, 50e-3, kSiteB, 6e-3, 0.15}, kTick);
    ASSERT_LE(answer.position, surface + MotionGateConfig{}.depth_max);
  }
  EXPECT_EQ(gate.place(), kSiteB);
  EXPECT_EQ(*gate.surface(), surface);
}

TEST(MotionGateTest, AfterAnyHaltThePlaneSetsOutFromRest) {
  for (const SiteState state : {SiteState::Hold, SiteState::Engaged}) {
    MotionGate gate = gate_at(-10e-3);
    const MotionRequest on_its_way{SiteState::Engaged, -10e-3, kSiteB, -10e-3, 0};
    for (int i = 0; i < 60; ++i) (void)gate.pass(on_its_way, kTick);
    // Not followed in Hold, nor where a force is walked away from.
    const Place stood = gate.pass({state, -10e-3, kSiteB, -10e-3, 3.5}, kTick).place;
    const Place next = gate.pass(on_its_way, kTick).place;
    EXPECT_LE(distance(next, stood), 8e-6 + 1e-12) << to_string(state);
  }
}

TEST(MotionGateTest, ARetreatFromForceDoesNotDrag) {
  MotionGate gate = gate_at(2e-3);
  touch(gate, 2e-3, 3.5);
  for (int i = 0; i < 100; ++i) {
    const MotionAnswer answer =
        gate.pass({SiteState::Engaged, 2e-3, kSiteB, gate.command(), 3.5}, kTick);
    EXPECT_EQ(answer.place, kSiteA);
  }
}

TEST(MotionGateTest, LearnsTheSurfaceAnewAtAnotherPlace) {
  MotionGate gate = gate_at(0);
  touch(gate, 0, 0.1);
  const double first = *gate.surface();
  let_go(gate, -5e-3);
  (void)go_to(gate, {10e-3, 0}, -5e-3);
  EXPECT_EQ(*gate.surface(), first) << "until something else is felt";
  touch(gate, 2e-3, 0.1);
  // The threshold follows the noise of the sensor, and with it the depth of the first contact.
  EXPECT_NEAR(*gate.surface(), first + 2e-3, 0.1e-3);
}

TEST(MotionGateTest, MayFollowWithoutContactOrWellOutside) {
  MotionGate gate = gate_at(0);
  EXPECT_TRUE(gate.free_to_follow(0));
  touch(gate, 1e-3, 0.3);
  EXPECT_FALSE(gate.free_to_follow(1e-3));
  EXPECT_TRUE(gate.free_to_follow(-5e-3));
  let_go(gate, 1e-3);
  EXPECT_TRUE(gate.free_to_follow(1e-3));
}

}  // namespace
}  // namespace palp::patient
