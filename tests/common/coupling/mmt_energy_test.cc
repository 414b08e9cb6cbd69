// Goal: whatever a patient site says, the hand gets no more energy than the tank held at first.
// Method: a simulated hand presses against random models; its work is booked from its own states
// every 0.1 ms. The same hand with a law that has no guard must break the bound, or the test would
// prove nothing.

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/coupling/mmt.h"
#include "tests/common/coupling/hand_loop.h"

namespace palp::coupling {
namespace {

/// One tick of force held while the hand moves on, and half an encoder count at 1 N.
constexpr double kSlack = 0.05e-3;  // [J]

/// Renders the newest model as it is: what the guard is there to prevent.
class UnguardedSurgeon {
 public:
  void begin_epoch(double /*position*/) noexcept {}
  SurgeonOutput step(const SurgeonInput& in, Duration /*dt*/) noexcept {
    if (const Incoming* last = newest(in.arrived)) {
      const auto* model = std::get_if<ModelPayload>(&last->sample.payload);
      if (model != nullptr && is_sound(*model, 60e-3)) shown_ = contact_model(*model);
    }
    SurgeonOutput out;
    out.force = shown_.force(in.position - shown_.surface);
    return out;
  }

 private:
  ContactModel shown_;
};

TEST(MmtEnergyTest, AHandNeverGetsMoreThanTheTankHeldWhateverItIsTold) {
  const MmtConfig config;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto outcome = hand_loop::press_against_lies(MmtSurgeon{config}, seed);
    EXPECT_LE(outcome.taken, config.tank) << "seed " << seed;
  }
}

/// A firm hand that rests in a place as it becomes known, is pushed out of it and then goes; its
/// encoder counts from `offset` [m] on. @returns the energy that it got [J].
double pushed_out(double offset) {
  constexpr double kEncoder = 0.03e-3;
  hand_loop::Hand hand{.mass = 0.195, .damping = 10, .stiffness = 900, .position = 6e-3};
  MmtSurgeon law{MmtConfig{}};
  Incoming told;
  told.fresh = true;
  told.sample.payload = ModelPayload{.version = 1, .c = {1.2}, .depth_max = 6e-3};
  const std::array arrived{told};
  const auto counted = [&] {
    return kEncoder * std::round((hand.position + offset) / kEncoder) - offset;
  };
  law.begin_epoch(counted());
  SurgeonInput in{.state = SiteState::Engaged, .arrived = arrived};
  for (int tick = 0; tick < 5000; ++tick) {
    in.position = counted();
    in.force_applied = law.step(in, std::chrono::milliseconds{1}).force;
    hand.live(6e-3 - 10e-6 * std::max(0, tick - 4000), in.force_applied);
  }
  return -hand.work_min;
}

TEST(MmtEnergyTest, AFirmHandThatIsPushedOutAndGoesGetsNoMoreThanTheTank) {
  double most = 0;
  for (int i = 0; i < 30; ++i) most = std::max(most, pushed_out(1e-6 * i));
  EXPECT_LE(most, MmtConfig{}.tank);
  EXPECT_GE(most, 0.93 * MmtConfig{}.tank) << "and little is left of it";
}

TEST(MmtEnergyTest, WithoutTheGuardTheSameHandGetsManyTimesThat) {
  const MmtConfig config;
  int broken = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto outcome = hand_loop::press_against_lies(UnguardedSurgeon{}, seed);
    if (outcome.taken > 5 * config.tank) ++broken;
  }
  EXPECT_EQ(broken, 10);
}

TEST(MmtEnergyTest, ItsBooksNeverHoldMoreThanTheTankAtFirstAndTheWorkDone) {
  const MmtConfig config;
  MmtSurgeon law{config};
  law.begin_epoch(0);
  hand_loop::Liar liar{7};
  double position = 0;
  double force = 0;
  double work = 0;
  for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
    const double t = 1e-3 * static_cast<double>(tick);
    const double next = 3e-3 * std::sin(5 * t) + 1e-3 * std::sin(33 * t);
    work += force * (next - position);
    position = next;
    const std::array arrived{liar.tell(tick)};
    SurgeonInput in;
    in.state = SiteState::Engaged;
    in.position = position;
    in.force_applied = force;
    in.arrived = arrived;
    force = law.step(in, std::chrono::milliseconds{1}).force;
    ASSERT_LE(law.tank() + law.stored(), config.tank + work + 1e-12) << "tick " << tick;
    ASSERT_GE(work, -config.tank - kSlack) << "tick " << tick;
  }
}

TEST(MmtEnergyTest, FromAirToAirTheHandGetsNoMoreThanTheTankHoweverMuchItDidBefore) {
  const MmtConfig config;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    MmtSurgeon law{config};
    law.begin_epoch(0);
    hand_loop::Liar liar{seed};
    double position = 0;
    double force = 0;
    double work = 0;
    double most = 0;  // of the work, where nothing was shown
    for (std::uint64_t tick = 0; tick < 30'000; ++tick) {
      const double t = 1e-3 * static_cast<double>(tick);
      // It works in the air, then presses.
      const double next = -4e-3 * std::cos(2 * t) + 2e-3 * std::sin(41 * t);
      work += force * (next - position);
      position = next;
      if (law.stored() == 0) most = std::max(most, work);
      const std::array arrived{liar.tell(tick)};
      SurgeonInput in;
      in.state = SiteState::Engaged;
      in.position = position;
      in.force_applied = force;
      in.arrived = arrived;
      force = law.step(in, std::chrono::milliseconds{1}).force;
      ASSERT_GE(work, most - config.tank - kSlack) << "seed " << seed << ", tick " << tick;
    }
    EXPECT_GT(most, 3 * config.tank) << "there was something to save up";
  }
}

}  // namespace
}  // namespace palp::coupling
