#include "common/coupling/tdpa.h"

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
    EXPECT_LE(free_air_drag_after(seed), 1.5 * config.damping) << "seed " << seed;
  }
}

RC_GTEST_PROP(TdpaTest, TheForceNeverChangesFasterThanItsSlew, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const TdpaConfig config;
  TdpaSurgeon law{config};
  law.begin_epoch(0);
  double force = 0;
  for (std::uint64_t tick = 0; tick < 500; ++tick) {
    const std::array arrived{
        from_patient(3 * random_uniform(seed, 0, tick), 1e-3 * random_uniform(seed, 1, tick))};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = 1e-3 * random_normal(seed, 2, tick / 7);
    in.force_applied = force;
    in.arrived = arrived;
    const double next = law.step(in, kTick).force;
    RC_ASSERT(std::abs(next - force) <= config.slew * 1e-3 + 1e-12);
    force = next;
  }
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
