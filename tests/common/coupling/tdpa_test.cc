#include "common/coupling/tdpa.h"

#include <algorithm>
#include <cmath>

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

constexpr double kForceMax = 5;  // [N], 3 of the peer and drag of 10 N s/m at 0.2 m/s

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
  const TdpaConfig config;
  TdpaSurgeon law{config};
  law.begin_epoch(0);
  double force = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const std::array arrived{from_patient(tick / 250 % 2 == 0 ? 0 : 3, 1)};
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
