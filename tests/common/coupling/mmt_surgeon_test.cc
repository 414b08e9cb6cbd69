#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "common/coupling/mmt.h"
#include "tests/common/coupling/hand_loop.h"
#include "tests/common/coupling/told_hand.h"

namespace palp::coupling {
namespace {

/// A still hand 4 mm deep in a place where nothing was known; then a model arrives.
struct Discovery {
  double stored{};    ///< [J]
  double rate_max{};  ///< [N/s]
  double force{};     ///< [N]
  double missing{};   ///< [N]
};
Discovery discover(const ModelPayload& model) {
  MmtConfig config;
  MmtSurgeon law{config};
  law.begin_epoch(4e-3);
  Incoming incoming;
  incoming.sample.payload = model;
  incoming.fresh = true;
  const std::array arrived{incoming};
  Discovery found;
  for (int tick = 0; tick < 3000; ++tick) {
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = 4e-3;
    in.force_applied = found.force;
    in.round_trip = std::chrono::milliseconds{100};
    in.arrived = arrived;
    const SurgeonOutput out = law.step(in, std::chrono::milliseconds{1});
    const double force = out.force;
    found.missing = out.force_missing;
    found.rate_max = std::max(found.rate_max, (force - found.force) / 1e-3);
    found.force = force;
  }
  found.stored = law.stored();
  return found;
}

/// A count of 30 um to and fro: what is told of its speed stands until the next telegram comes.
TEST(MmtSurgeonTest, TheToldSpeedOfAHandThatTremblesByACountIsSmallAndThatOfAnEvenHandIsTrue) {
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(0);
  SurgeonInput in;
  in.state = SiteState::Engaged;
  for (int tick = 0; tick < 400; ++tick) {
    in.velocity = tick % 2 == 0 ? 30e-3 : -30e-3;
    const SurgeonOutput out = law.step(in, std::chrono::milliseconds{1});
    if (tick > 200) {
      EXPECT_LT(std::abs(out.to_patient.velocity), 3e-3) << tick;
    }
  }
  for (int tick = 0; tick < 200; ++tick) {
    in.velocity = 20e-3;
    in.position += 20e-6;
    const SurgeonOutput out = law.step(in, std::chrono::milliseconds{1});
    if (tick > 100) {
      EXPECT_NEAR(out.to_patient.velocity, 20e-3, 0.1e-3) << tick;
    }
  }
}

TEST(MmtSurgeonTest, ASurfaceFoundWhilePressingIsLetInAsFarAsTheTankPays) {
  const ModelPayload soft{.version = 1, .c = {0, 0.03}, .depth_max = 4e-3};
  const ModelPayload hard{.version = 1, .c = {0, 0.3}, .depth_max = 4e-3};
  const ContactModel whole = contact_model(soft);
  const MmtConfig config;
  ASSERT_LT(whole.energy(4e-3), config.tank);
  EXPECT_NEAR(discover(soft).force, whole.force(4e-3), 1e-6) << "all of it";
  EXPECT_NEAR(discover(hard).stored, config.tank, 1e-9) << "as much as was there";
  EXPECT_LE(discover(soft).rate_max, config.slew_small + 1e-6);
  EXPECT_LE(discover(hard).rate_max, config.slew_small + 1e-6);
}

TEST(MmtSurgeonTest, AHeldForceNeedsLessEnergyThanTheSpringBehindIt) {
  const ModelPayload hard{.version = 1, .c = {0, 0.12}, .depth_max = 4e-3};
  const ContactModel whole = contact_model(hard);
  const MmtConfig config;
  const double force = whole.force(4e-3);
  ASSERT_GT(whole.energy(4e-3), 1.2 * config.tank) << "the spring is too dear";
  ASSERT_LT(ReleaseLine{config.release}.least(force), config.tank) << "its force is not";
  EXPECT_NEAR(discover(hard).force, force, 1e-6);
  EXPECT_NEAR(discover(hard).missing, 0, 1e-6);
  EXPECT_GT(discover({.version = 1, .c = {0, 0.6}, .depth_max = 4e-3}).missing, 0.1);
}

/// Two tissues that give a hand at rest the same force: a stiff one, and a soft one whose surface
/// is far above. On the way from one to the other little happens at the hand.
TEST(MmtSurgeonTest, BetweenTwoTissuesOfTheSameForceTheForceStays) {
  const ModelPayload stiff{.version = 1, .c = {0, 0.04}, .depth_max = 3e-3};
  ModelPayload soft{.version = 2, .c = {0, 0.04}, .surface = -4e-3, .depth_max = 7e-3};
  const double wanted = contact_model(stiff).force(3e-3);
  soft.c[1] *= wanted / contact_model(soft).force(7e-3);
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(3e-3);
  double force = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    force = told_hand(law, tick < 2000 ? stiff : soft, 3e-3, force);
    if (tick < 1500) continue;
    ASSERT_NEAR(force, wanted, 0.03) << tick;
  }
  EXPECT_LT(law.shown().elastic().surface, -3.9e-3) << "it is another tissue";
}

/// A hand that leaves unknown tissue at `speed` [m/s] while its model arrives: the force [N] after
/// 20 ms.
double discover_leaving(double speed) {
  MmtSurgeon law{MmtConfig{}};
  double position = 5e-3;
  law.begin_epoch(position);
  Incoming incoming;
  incoming.fresh = true;
  double force = 0;
  for (int tick = 0; tick < 120; ++tick) {
    position -= 1e-3 * speed;
    if (tick == 100) {
      incoming.sample.payload = ModelPayload{.version = 1, .c = {0, 0.06}, .depth_max = 5e-3};
    }
    const std::array arrived{incoming};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = position;
    in.force_applied = force;
    in.round_trip = std::chrono::milliseconds{100};
    in.arrived = arrived;
    force = law.step(in, std::chrono::milliseconds{1}).force;
  }
  return force;
}

TEST(MmtSurgeonTest, ATissueFoundWhileTheHandIsThrownOutOfItDoesNotPushItOn) {
  EXPECT_GT(discover_leaving(0), 0.015);
  EXPECT_EQ(discover_leaving(0.035), 0);
}

/// A light hand taps unknown tissue, whose model arrives `late` ticks after it touched it: how far
/// [m] it is thrown back before it comes in deeper.
double thrown_back(int late) {
  MmtSurgeon law{MmtConfig{}};
  hand_loop::Hand hand{.mass = 0.085, .damping = 1, .stiffness = 80};
  law.begin_epoch(hand.position);
  Incoming incoming;
  incoming.fresh = true;
  int touched_for = 0;
  double force = 0;
  double deepest = hand.position;
  double retreat = 0;
  double thrown = 0;
  for (int tick = 0; tick < 500; ++tick) {
    if (hand.position > 0) ++touched_for;
    if (touched_for == late) {
      incoming.sample.payload = ModelPayload{.version = 1, .c = {0, 0.06}, .depth_max = 4e-3};
    }
    const std::array arrived{incoming};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = hand.position;
    in.force_applied = force;
    in.round_trip = std::chrono::milliseconds{20};
    in.arrived = arrived;
    force = law.step(in, std::chrono::milliseconds{1}).force;
    hand.live(-3e-3 + 6.5e-3 * (1 - std::cos(2 * std::numbers::pi * 1e-3 * tick)), force);
    if (hand.position > deepest) {
      deepest = hand.position;
      thrown = std::max(thrown, retreat);
      retreat = 0;
    }
    retreat = std::max(retreat, deepest - hand.position);
  }
  return thrown;
}

TEST(MmtSurgeonTest, TheFirstTapOfALightHandIsOneStroke) {
  for (const int late : {20, 30, 40, 50, 60, 80, 100}) {
    EXPECT_LT(thrown_back(late), 0.3e-3) << late << " ms";
  }
}

TEST(MmtSurgeonTest, AnotherBreathThanForeseenComesInSlowly) {
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(-1e-3);
  ModelPayload model{.version = 1, .c = {0, 0.06}, .depth_max = 4e-3};
  std::array<double, 1200> forces{};
  for (std::size_t tick = 0; tick < forces.size(); ++tick) {
    if (tick == 1000) {
      model.version = 2;
      model.swing = 2e-3;
      model.swing_rate = 1.5;
    }
    const double position = std::min(3e-3, -1e-3 + 20e-6 * static_cast<double>(tick));
    forces[tick] = told_hand(law, model, position, tick > 0 ? forces[tick - 1] : 0);
  }
  ASSERT_GT(forces[999], 0.25);
  EXPECT_LT(forces[1199], 0.1) << "it does come in";
  for (std::size_t tick = 1000; tick < 1100; ++tick) {
    EXPECT_LT(std::abs(forces[tick] - forces[tick - 10]), 0.1) << tick;
  }
}

TEST(MmtSurgeonTest, PressingFurtherIntoAKnownTissueIsNotSlewed) {
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(-1e-3);
  const ModelPayload model{.version = 1, .c = {0, 0.06}, .depth_max = 5e-3};
  double force = 0;
  for (int tick = 0; tick <= 50; ++tick) {
    // 0.1 m/s, four times a tap.
    force = told_hand(law, model, -1e-3 + 0.1e-3 * tick, force);
  }
  EXPECT_NEAR(force, contact_model(model).force(4e-3), 1e-9);
}

/// A hand at rest in a tissue that it knows; then it is told of another one.
TEST(MmtSurgeonTest, AForceThatIsToldAwayFallsSlowly) {
  const ModelPayload known{.version = 1, .c = {0, 0.3}, .depth_max = 5e-3};
  ModelPayload nothing = known;
  nothing.c = {};
  ModelPayload deeper = known;
  deeper.surface = 40e-3;
  for (const ModelPayload& told : {nothing, deeper}) {
    const MmtConfig config;
    MmtSurgeon law{config};
    law.begin_epoch(-1e-3);
    double force = 0;
    double work = 0;
    double most = 0;
    for (int tick = 0; tick <= 1000; ++tick) {
      Incoming incoming;
      incoming.sample.payload = tick < 500 ? known : told;
      incoming.fresh = true;
      const std::array arrived{incoming};
      SurgeonInput in;
      in.state = SiteState::Engaged;
      in.position = -1e-3 + 0.02e-3 * std::min(tick, 250);
      in.force_applied = force;
      in.arrived = arrived;
      if (tick <= 250) work += tick > 0 ? force * 0.02e-3 : 0;
      const double before = std::exchange(force, law.step(in, std::chrono::milliseconds{1}).force);
      ASSERT_TRUE(tick != 500 || before > 0.5) << before;
      if (tick >= 500) {
        EXPECT_LE(before - force, 1e-3 * config.fall + 1e-9) << tick;
        most = std::max(most, before - force);
      }
      ASSERT_LE(law.tank() + law.stored(), config.tank + work + 1e-12) << tick;
    }
    EXPECT_GT(most, 0.8e-3 * config.fall) << "there is something to hold back";
    EXPECT_LT(force, 0.01) << "it does go";
  }
}

TEST(MmtSurgeonTest, ABeginningEpochDoesNotRefillTheTank) {
  MmtConfig config;
  MmtSurgeon law{config};
  law.begin_epoch(4e-3);
  Incoming incoming;
  incoming.sample.payload = ModelPayload{.version = 1, .c = {0, 0.3}, .depth_max = 4e-3};
  incoming.fresh = true;
  const std::array arrived{incoming};
  for (int tick = 0; tick < 3000; ++tick) {
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = 4e-3;
    in.arrived = arrived;
    (void)law.step(in, std::chrono::milliseconds{1});
  }
  const double left = law.tank();
  ASSERT_LT(left, 1e-9);
  law.begin_epoch(0);
  EXPECT_LE(law.tank(), left);
}

/// A hand that a hard tissue surprised 4 mm deep, which took the whole tank; then it moves.
class SurprisedHand {
 public:
  explicit SurprisedHand(const MmtConfig& config) : law_{config} {
    law_.begin_epoch(position_);
    incoming_.sample.payload = ModelPayload{.version = 1, .c = {0, 0.3}, .depth_max = 4e-3};
    incoming_.fresh = true;
    (void)move(0, 3000);
  }
  /// The force [N] after `ticks` at `speed` [m/s].
  double move(double speed, int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      position_ += 1e-3 * speed;
      const std::array arrived{incoming_};
      SurgeonInput in;
      in.state = SiteState::Engaged;
      in.position = position_;
      in.force_applied = force_;
      in.arrived = arrived;
      force_ = law_.step(in, std::chrono::milliseconds{1}).force;
    }
    return force_;
  }
  [[nodiscard]] double tank() const { return law_.tank(); }
  [[nodiscard]] double held() const { return law_.tank() + law_.stored(); }  ///< [J]

 private:
  MmtSurgeon law_;
  Incoming incoming_;
  double position_{4e-3};  ///< [m]
  double force_{};         ///< [N]
};

TEST(MmtSurgeonTest, AnEmptyTankIsPaidBackOnTheWayOutAndInTheAirAndNotOnTheWayIn) {
  const MmtConfig config;
  MmtConfig lenient = config;
  lenient.repay_contact = 0;
  lenient.repay_air = 0;
  SurprisedHand hand{config};
  SurprisedHand other{lenient};
  ASSERT_LT(hand.tank(), 0.01 * config.tank);
  EXPECT_EQ(hand.move(20e-3, 20), other.move(20e-3, 20)) << "on the way in";
  // On the way out what is paid back goes at once into force that was missing.
  (void)hand.move(-20e-3, 50);
  (void)other.move(-20e-3, 50);
  EXPECT_GT(hand.held(), other.held());
  (void)hand.move(-20e-3, 300);
  (void)other.move(-20e-3, 300);
  const double before = hand.tank();
  const double before_other = other.tank();
  (void)hand.move(-20e-3, 400);
  (void)other.move(-20e-3, 400);
  EXPECT_GT(hand.tank() - before, other.tank() - before_other) << "in the air";
}

TEST(MmtSurgeonTest, ShowsNothingWhereTheGateLetsNothingThrough) {
  for (const SiteState state : {SiteState::Parked, SiteState::Clutched, SiteState::Stopped}) {
    MmtSurgeon law{MmtConfig{}};
    law.begin_epoch(0);
    Incoming incoming;
    incoming.sample.payload = ModelPayload{.version = 1, .c = {0, 0.06}};
    incoming.fresh = true;
    const std::array arrived{incoming};
    SurgeonInput in;
    in.state = state;
    in.position = 4e-3;
    in.arrived = arrived;
    EXPECT_EQ(law.step(in, std::chrono::milliseconds{1}).force, 0);
    EXPECT_EQ(law.stored(), 0);
  }
}

TEST(MmtSurgeonTest, OfATissueTooStiffForTheDeviceItShowsWhatTheDeviceMayShow) {
  const MmtConfig config;
  const ModelPayload stiff{.version = 1, .c = {5}, .depth_max = 4e-3};
  MmtSurgeon law{config};
  law.begin_epoch(-1e-3);
  Incoming incoming;
  incoming.sample.payload = stiff;
  incoming.fresh = true;
  const std::array arrived{incoming};
  SurgeonOutput out;
  for (int tick = 0; tick < 200; ++tick) {
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = std::min(1e-3, -1e-3 + 20e-6 * tick);
    in.force_applied = out.force;
    in.arrived = arrived;
    out = law.step(in, std::chrono::milliseconds{1});
  }
  EXPECT_NEAR(out.force, config.slope_max * 1e-3, 0.01) << "5 N were there";
  EXPECT_NEAR(out.force + out.force_too_stiff, 5, 0.01) << "it says what it does not show";
  EXPECT_NEAR(out.force_missing, 0, 0.01) << "of what it may show nothing is missing";
  EXPECT_EQ(law.refused(), 0U);
}

TEST(MmtSurgeonTest, RefusesAndCountsModelsThatNoTissueHas) {
  MmtSurgeon law{MmtConfig{}};
  law.begin_epoch(0);
  Incoming incoming;
  incoming.sample.payload = ModelPayload{.version = 1, .c = {-1}};
  incoming.fresh = true;
  const std::array arrived{incoming};
  SurgeonInput in;
  in.state = SiteState::Engaged;
  in.position = 4e-3;
  in.arrived = arrived;
  EXPECT_EQ(law.step(in, std::chrono::milliseconds{1}).force, 0);
  EXPECT_EQ(law.refused(), 1U);
}

}  // namespace
}  // namespace palp::coupling
