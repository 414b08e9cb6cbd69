#include "common/coupling/tdpa.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"

namespace palp::coupling {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

Incoming from_patient(double force, double energy) {
  Incoming incoming;
  incoming.sample.force = force;
  incoming.sample.payload = TdpaPayload{energy};
  incoming.fresh = true;
  return incoming;
}

/// A hand that is dragged about while a patient site reports forces and puts little energy in.
double free_air_drag_after(std::uint64_t seed) {
  TdpaSurgeon law{TdpaConfig{}};
  law.begin_epoch(0);
  double force = 0;
  double position = 0;
  for (std::uint64_t tick = 0; tick < 4000; ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    position = 3e-3 * std::sin(8 * t);
    const std::array arrived{from_patient(random_uniform(seed, 0, tick / 100), 1e-4 * t)};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = position;
    in.force_applied = force;
    if (tick % 2 == 0) in.arrived = arrived;
    force = law.step(in, kTick).force;
  }
  // The tissue is gone: what is left after the debts are paid?
  double drag = 0;
  double speed = 0;
  for (std::uint64_t tick = 4000; tick < 9000; ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    speed = 24e-3 * std::cos(8 * t);
    const double next = 3e-3 * std::sin(8 * t);
    const std::array arrived{from_patient(0, 0)};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = next;
    in.force_applied = force;
    in.arrived = arrived;
    force = law.step(in, kTick).force;
    if (tick > 8000 && std::abs(speed) > 20e-3) drag = std::max(drag, std::abs(force / speed));
  }
  return drag;
}

TEST(TdpaTest, DebtsArePaidOffSoThatFreeAirIsFreeAgainAfterAnyHistory) {
  const TdpaConfig config;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_LE(free_air_drag_after(seed), 1.1 * config.damping_back) << "seed " << seed;
  }
}

/// A hand dragged about by chance, a peer that says what it likes, in whatever order.
struct Ordeal {
  explicit Ordeal(std::uint64_t seed_of_it) : seed{seed_of_it} { law.begin_epoch(0); }

  void step(std::uint64_t tick) {
    const std::array arrived{from_patient(3 * random_uniform(seed, 0, tick / 30),
                                          2e-3 * random_uniform(seed, 1, tick / 50))};
    SurgeonInput in;
    in.state = random_uniform(seed, 3, tick / 300) < 0.2 ? SiteState::Hold : SiteState::Engaged;
    const double before = position;
    // In 30 um steps, as an encoder counts, and sometimes so slowly that it creeps.
    aim += 0.06e-3 * random_normal(seed, 2, tick / 40) * random_uniform(seed, 4, tick / 200);
    aim = std::clamp(aim, -5e-3, 5e-3);
    position = 30e-6 * std::round(aim / 30e-6);
    way = position - before;
    work += force * way;
    in.position = position;
    in.force_applied = force;
    in.round_trip = from_seconds(random_uniform(seed, 6, tick / 400));
    if (random_uniform(seed, 5, tick) < 0.7) in.arrived = arrived;
    const SurgeonOutput out = law.step(in, kTick);
    force = out.force;
    sent = std::get<TdpaPayload>(out.to_patient.payload).energy_in;
  }

  TdpaConfig config;
  TdpaSurgeon law{config};
  std::uint64_t seed;
  double aim{};
  double position{};
  double way{};   ///< [m], of this tick
  double work{};  ///< [J], of the hand
  double force{};
  double sent{};  ///< [J]
};

// [N], 3 of the peer, 250 N/m over 10 mm and drag of 10 N s/m at 0.2 m/s
constexpr double kForceMax = 7.5;

RC_GTEST_PROP(TdpaTest, TheHandGetsNoMoreThanItGaveAndTheOtherEndIsKnownToHaveGiven, ()) {
  Ordeal ordeal{*rc::gen::arbitrary<std::uint64_t>()};
  double held_max = 0;  // [J], what holding a force for a tick may cost
  for (std::uint64_t tick = 0; tick < 3000; ++tick) {
    ordeal.step(tick);
    held_max = std::max(held_max, kForceMax * std::abs(ordeal.way));
    const double known = ordeal.law.energy_remote();
    RC_ASSERT(ordeal.law.energy_out() <= known + 1e-12);
    // After a turn of the hand drag points the wrong way until the filter of the speed has
    // followed.
    RC_ASSERT(-ordeal.work <= known - ordeal.sent + held_max);
  }
}

/// A hand led about, with a tip where and as it is said.
struct Led {
  explicit Led(double round_trip) : trip{from_seconds(round_trip)} { law.begin_epoch(0); }

  double step(double next, double tip_force, double tip, double energy, bool heard = true) {
    Incoming incoming = from_patient(tip_force, energy);
    incoming.sample.position = tip;
    const std::array arrived{incoming};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.round_trip = trip;
    work += force * (next - position);
    in.position = position = next;
    in.force_applied = force;
    if (heard) in.arrived = arrived;
    const SurgeonOutput out = law.step(in, kTick);
    sent = std::get<TdpaPayload>(out.to_patient.payload).energy_in;
    return force = out.force;
  }
  /// 2 s to and fro in the air: work that the damping takes.
  void stir() {
    for (int tick = 0; tick < 2000; ++tick) {
      (void)step(5e-3 * std::sin(2e-3 * std::numbers::pi * tick), 0, position, 0);
    }
  }

  TdpaSurgeon law{TdpaConfig{}};
  Duration trip;
  double position{};
  double force{};
  double work{};  ///< [J], of the hand
  double sent{};  ///< [J]
};

TEST(TdpaTest, OverALongPathAHandAtRestIsGivenALateForceOutOfWorkItHasDone) {
  Led led{0.5};
  led.stir();
  for (int tick = 0; tick < 2000; ++tick) (void)led.step(0, 0.6, 0, 0);
  EXPECT_NEAR(led.force, 0.6, 0.01);
  EXPECT_GT(led.work, 0);
}

TEST(TdpaTest, OverALongPathAHandThatMovesOnIsNotPushedAfter) {
  Led led{0.5};
  for (int tick = 0; tick < 2000; ++tick) (void)led.step(0, 0.6, 0, 1);
  ASSERT_NEAR(led.force, 0.6, 0.01);
  led.work = 0;
  // The tip is said to be with the hand, and its force to last.
  for (int tick = 1; tick <= 500; ++tick) {
    const double next = -30e-6 * tick;
    (void)led.step(next, 0.6, next, 1);
  }
  EXPECT_GT(led.work, -0.6e-3) << "pushed on all the way it would have been given 9 mJ";
}

TEST(TdpaTest, OnlyOverALongPathTheForceGoesOnFromWhereTheTipWas) {
  for (const double trip : {0.0, 0.2}) {
    Led led{trip};
    for (int tick = 0; tick < 3000; ++tick) (void)led.step(1e-3, 0.3, 0, 1);
    EXPECT_NEAR(led.force, trip > 0 ? 0.3 + 0.25 : 0.3, 0.01) << trip << " s";
  }
}

TEST(TdpaTest, StepsOfATransducerInTheAirAreNoTouchHoweverRarelySamplesCome) {
  for (const int every : {1, 9}) {
    Led led{0.5};
    led.stir();
    for (int tick = 0; tick < 3000; ++tick) {
      const double step = tick / every % 12 == 0 ? 0.05 : 0;
      (void)led.step(5e-3, step, -5e-3, 1, tick % every == 0);
      if (tick > 500) {
        ASSERT_LT(led.force, 0.02) << "tick " << tick << ", every " << every;
      }
    }
  }
}

TEST(TdpaTest, ForceAndDragTogetherChangeByLessThanATenthOfANewtonInThreeMilliseconds) {
  Led led{0};
  double before = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    const double aim = 2e-3 * std::sin(12e-3 * tick);
    const double tip_force = tick / 37 % 2 == 0 ? 0 : 1.5;
    const double next = led.step(30e-6 * std::round(aim / 30e-6), tip_force, led.position, 1);
    ASSERT_LE(std::abs(next - before), 0.1 / 3) << "tick " << tick;
    before = next;
  }
}

TEST(TdpaTest, EnergyThatIsNotNeededHereGoesBack) {
  const TdpaConfig config;
  Led led{0.02};
  for (int tick = 0; tick < 10; ++tick) (void)led.step(0, 0, 0, 20e-3);
  EXPECT_NEAR(led.sent, 20e-3 - config.credit - 0.5 * config.reserve, 1e-6);
}

TEST(TdpaTest, AHandThatCreepsOutGetsNothingFromAPeerThatGaveNothing) {
  TdpaSurgeon law{TdpaConfig{}};
  law.begin_epoch(0);
  const std::array arrived{from_patient(2, 0)};
  double force = 0;
  double work = 0;
  double before = 0;
  for (int tick = 0; tick < 20'000; ++tick) {
    // In at 50 mm/s, out at 1 mm/s: where only speed made the controller work, this pumped.
    const int phase = tick % 1020;
    const double position = phase < 20 ? phase * 50e-6 : 1e-3 - (phase - 20) * 1e-6;
    work += force * (position - before);
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = position;
    in.force_applied = force;
    in.arrived = arrived;
    force = law.step(in, kTick).force;
    before = position;
  }
  EXPECT_GE(work, -1e-6);
}

TEST(TdpaTest, AForceThatAppearsOrEndsDoesNotJump) {
  TdpaConfig config;
  config.tank.start = 20e-3;  // somebody else pushes the tip: more than a tank believes of tissue
  TdpaSurgeon law{config};
  law.begin_epoch(0);
  double force = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    // Each time it appears the other end has put in what it costs.
    const int phase = tick / 250;
    const std::array arrived{from_patient(phase % 2 == 0 ? 0 : 3, 10e-3 * phase)};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.force_applied = force;
    in.arrived = arrived;
    const double next = law.step(in, kTick).force;
    EXPECT_LE(std::abs(next - force), config.slew * 1e-3 + 1e-12);
    force = next;
  }
  EXPECT_NEAR(force, 3, 1e-9) << "what was paid for is felt";
}

TEST(TdpaTest, LateOrRepeatedEnergyNeverLowersWhatIsKnown) {
  TdpaPatient law{TdpaConfig{}};
  law.begin_epoch(0);
  const auto hand = [](double position, double energy) {
    Incoming incoming;
    incoming.sample.position = position;
    incoming.sample.payload = TdpaPayload{energy};
    incoming.fresh = true;
    return incoming;
  };
  PatientInput in;
  in.state = SiteState::Engaged;
  in.contact_force = 1;
  double target = 0;
  const std::array rich{hand(5e-3, 1)};
  const std::array poor{hand(5e-3, 0)};
  for (int tick = 0; tick < 200; ++tick) {
    in.arrived = tick == 0 ? std::span<const Incoming>{rich} : std::span<const Incoming>{poor};
    target = law.step(in, kTick).target_position;
  }
  EXPECT_NEAR(target, 5e-3, 1e-4) << "1 J known once pays for all of it";
}

}  // namespace
}  // namespace palp::coupling
