#include "common/coupling/release_line.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/core/device_facts.h"
#include "common/core/random.h"

namespace palp::coupling {
namespace {

constexpr ReleaseLineConfig kConfig;
constexpr double kCount = 1e-6;  // [m], of a way

/// A hand to which `force` [N] is held, with just the energy that it needs, and that has since gone
/// in by `in` [m]: so far out the force stays.
ReleaseLine held(double force, double in = 0) {
  ReleaseLine line{kConfig};
  line.move(in);
  line.hold(force, line.least(force));
  return line;
}

TEST(ReleaseLineTest, TheEnergyIsTheWorkThatTheForceDoesOnItsWayOut) {
  for (const double force : {0.1, 0.4, 0.8, 1.6}) {
    for (const double in : {0.0, 20e-6, 60e-6}) {
      ReleaseLine line = held(force, in);
      const double energy = line.energy();
      double work = 0;
      for (int i = 0; i < 3000; ++i) {
        const double before = line.force();
        line.move(-kCount);
        work += 0.5 * (before + line.force()) * kCount;
      }
      EXPECT_EQ(line.force(), 0) << force;
      EXPECT_NEAR(work, energy, 1e-3 * energy) << force << " N, " << in << " m";
    }
  }
}

/// No tremble takes energy: whatever way a hand went, back where it was it has what it had.
TEST(ReleaseLineTest, TheWayBackIsTheWayOut) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ReleaseLine line = held(0.9, 30e-6);
    double out = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
      const double next = 200e-6 * random_uniform(seed, 1, i);
      line.move(out - next);
      out = next;
      const double expected = 0.9 - kConfig.steepest * std::max(0.0, out - 30e-6);
      ASSERT_NEAR(line.force(), std::max(0.0, expected), 1e-9) << "seed " << seed;
    }
  }
}

TEST(ReleaseLineTest, TheLargerTheForceTheSteeperButNoSteeperThanADeviceBears) {
  const auto steepness = [](double force) {
    ReleaseLine line = held(force);
    line.move(-kCount);
    return (force - line.force()) / kCount;
  };
  EXPECT_NEAR(steepness(0.1), kConfig.soft, 1);
  EXPECT_NEAR(steepness(0.5), 0.5 / kConfig.way, 1);
  EXPECT_NEAR(steepness(3), kConfig.steepest, 1);
}

TEST(ReleaseLineTest, ItIsAsSoftAsTheEnergyPays) {
  ReleaseLine line{kConfig};
  line.hold(0.5, 0.4e-3);
  EXPECT_NEAR(line.energy(), 0.4e-3, 1e-12);
  ReleaseLine poor{kConfig};
  poor.hold(0.5, line.least(0.5));
  line.move(-50e-6);
  poor.move(-50e-6);
  EXPECT_GT(line.force(), poor.force() + 0.05);
}

/// A hand that trembles on the steep part: once it rests there for a while the force stays.
TEST(ReleaseLineTest, ThePlayComesToWhereTheHandRests) {
  ReleaseLine line = held(0.6);
  line.move(-40e-6);
  for (int tick = 0; tick < 500; ++tick) line.hold(line.force(), line.energy());
  const double force = line.force();
  ASSERT_LT(force, 0.5);
  for (int tremble = 0; tremble < 20; ++tremble) {
    line.move(tremble % 2 == 0 ? kConfig.play / 2 : -kConfig.play / 2);
    EXPECT_NEAR(line.force(), force, 5e-3);
  }
}

TEST(ReleaseLineTest, ADeviceThatAnswersLateGetsNoSteepLine) {
  EXPECT_EQ(at_device(kConfig, {}).steepest, kConfig.steepest);
  EXPECT_EQ(at_device(kConfig, {.lag = 5e-3}).steepest, kConfig.soft);
  EXPECT_EQ(at_device(kConfig, {.rate = 500}).steepest, kConfig.soft);
}

}  // namespace
}  // namespace palp::coupling
