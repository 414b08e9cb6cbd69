#include "common/coupling/port_tank.h"

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/coupling/tdpa.h"
#include "common/coupling/wave.h"

namespace palp::coupling {
namespace {

TEST(PortTankTest, ItHoldsWhatItHeldAtFirstAndTheWorkOfTheHand) {
  PortTank tank{PortTankConfig{}};
  tank.begin_epoch(2e-3);
  EXPECT_DOUBLE_EQ(tank.account(0.5, 4e-3), 2e-3);
  EXPECT_DOUBLE_EQ(tank.level(), 1e-3 + 0.5 * 2e-3);
  tank.begin_epoch(-7e-3);  // the axis moved, not the hand
  EXPECT_EQ(tank.account(0.5, -7e-3), 0);
  EXPECT_DOUBLE_EQ(tank.level(), 1e-3 + 0.5 * 2e-3);
}

TEST(PortTankTest, AHandThatLetsItselfBePushedByTheMostThereIsGetsWhatThereWas) {
  const PortTankConfig config;
  PortTank tank{config};
  double position = 0;  // [m]
  double taken = 0;     // [J]
  for (int tick = 0; tick < 10'000; ++tick) {
    const double force = tank.force_max();
    position -= 5e-6;
    taken += force * 5e-6;
    (void)tank.account(force, position);
  }
  EXPECT_NEAR(taken, config.start, 0.01e-3);
  EXPECT_LT(tank.force_max(), 0.05);
}

TEST(PortTankTest, MoreThanTheMostIsNotKept) {
  const PortTankConfig config;
  PortTank tank{config};
  (void)tank.account(8, 1);
  EXPECT_EQ(tank.level(), config.most);
}

/// [J], most that a hand has from a law whose other end declares more than anybody could have put
/// in, and tells forces and waves at random.
template <class Law, class Lie>
double taken_from(Law law, const Lie& lie, std::uint64_t seed) {
  constexpr double kTick = 1e-3;  // [s]
  double position = 0;            // [m]
  double velocity = 0;            // [m/s]
  double work = 0;                // [J]
  double least = 0;               // [J]
  double force = 0;               // [N]
  law.begin_epoch(position);
  for (std::uint64_t tick = 0; tick < 20'000; ++tick) {
    const double intent = 4e-3 * std::sin(4e-3 * static_cast<double>(tick));
    const double pull = 80 * (intent - position) - velocity;
    velocity += kTick * (pull - force) / 0.085;
    const double way = kTick * velocity;
    position += way;
    work += force * way;
    least = std::min(least, work);
    const TimePoint now{std::chrono::milliseconds{tick + 1}};
    Incoming incoming{.sample = lie(random_uniform(seed, 1, tick / 50)),
                      .number = tick,
                      .fresh = true,
                      .repaired = false,
                      .sent_at = PeerTimePoint{now.time_since_epoch()},
                      .arrived_at = now};
    const std::array arrived{incoming};
    SurgeonInput in;
    in.now = now;
    in.state = SiteState::Engaged;
    in.position = position;
    in.force_applied = force;
    in.arrived = arrived;
    in.round_trip = std::chrono::milliseconds{20};
    force = law.step(in, std::chrono::milliseconds{1}).force;
  }
  return -least;
}

TEST(PortTankTest, APeerThatOverstatesItsEnergyFeedsTheHandNoMoreThanTheTank) {
  constexpr double kSlack = 0.1e-3;  // [J], one tick of held force at the speeds of a thrown hand
  const PortTankConfig tank;
  PortTankConfig none;
  none.start = none.most = 1e9;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    double integral = 0;
    const auto waves = [&](double uniform) {
      integral += 1e-3 * 0.6 * (2 * uniform - 1);
      return PortSample{.payload = WavePayload{integral, 1e3}};
    };
    const auto forces = [](double uniform) {
      return PortSample{.force = 3 * uniform, .payload = TdpaPayload{1e3}};
    };
    EXPECT_LE(taken_from(WaveSurgeon{WaveConfig{}}, waves, seed), tank.start + kSlack) << seed;
    EXPECT_LE(taken_from(TdpaSurgeon{TdpaConfig{}}, forces, seed), tank.start + kSlack) << seed;
    // Or nothing was at stake.
    EXPECT_GT(taken_from(WaveSurgeon{WaveConfig{.tank = none}}, waves, seed), 5 * tank.start);
  }
}

}  // namespace
}  // namespace palp::coupling
