#include "surgeon_site/hand_plant.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "surgeon_site/tanh_table.h"

namespace palp::surgeon {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

constexpr Grip kGrips[]{kLightGrip, kMidGrip, kFirmGrip, kArmGrip};

HandPlantConfig with(const Grip& grip, Duration step = 100us) {
  HandPlantConfig config;
  config.grip = grip;
  config.step = step;
  return config;
}

TEST(TanhTableTest, AgreesWithTheLibrary) {
  const TanhTable table;
  double worst = 0;
  for (double x = -10; x <= 10; x += 1e-4)
    worst = std::max(worst, std::abs(table(x) - std::tanh(x)));
  EXPECT_LT(worst, 3e-7);
  EXPECT_EQ(table(1e300), 1);
  EXPECT_EQ(table(-1e300), -1);
  EXPECT_EQ(table(0), 0);
}

TEST(HandPlantTest, ConstantForceDeflectsTheHandByItsStiffness) {
  for (const Grip& grip : kGrips) {
    HandPlant plant{with(grip), 0};
    for (int i = 0; i < 5000; ++i) plant.advance({}, {}, 1.0, 1ms);
    // At rest nothing but the hand's spring carries the force: friction turns with the speed.
    EXPECT_NEAR(plant.position(), -1.0 / grip.stiffness, 1e-6);
    EXPECT_NEAR(plant.velocity(), 0, 1e-6);
  }
}

TEST(HandPlantTest, FollowsItsIntentInFreeAir) {
  HandPlant plant{with(kFirmGrip), 0};
  Pull last;
  for (int i = 1; i <= 4000; ++i) {
    const double turn = 2 * std::numbers::pi * 0.5;
    const double t = 1e-3 * i;
    const Pull next{5e-3 * (1 - std::cos(turn * t)), 5e-3 * turn * std::sin(turn * t)};
    plant.advance(last, next, 0, 1ms);
    last = next;
  }
  EXPECT_NEAR(plant.position(), last.position, 1e-4);
}

TEST(HandPlantTest, FreeMotionOnlyLosesEnergy) {
  for (const Grip& grip : kGrips) {
    HandPlantConfig config = with(grip);
    HandPlant plant{config, 10e-3};
    const auto energy = [&] {
      return (config.mass + grip.mass) * plant.velocity() * plant.velocity() / 2 +
             grip.stiffness * plant.position() * plant.position() / 2;
    };
    // Semi-implicit Euler keeps a neighbouring energy; the true one may swing by omega dt / 2.
    const double slack = energy() * std::sqrt(grip.stiffness / (config.mass + grip.mass)) * 1e-4;
    double least = energy();
    for (int i = 0; i < 2000; ++i) {
      plant.advance({}, {}, 0, 1ms);
      ASSERT_LE(energy(), least + slack);
      least = std::min(least, energy());
    }
    EXPECT_LT(least, 1e-3 * grip.stiffness * 10e-3 * 10e-3 / 2);
    EXPECT_EQ(plant.work(), 0);
  }
}

/// A hand tapping on a sampled spring: the loop of a virtual wall, without any network.
struct Tapped {
  double position{};  ///< [m]
  double work{};      ///< [J]
  double summed{};    ///< [J], sum of F dx, tick by tick
};

Tapped tap_a_wall(const Grip& grip, Duration step) {
  HandPlant plant{with(grip, step), -3e-3};
  Pull last{-3e-3, 0};
  Tapped out;
  for (int i = 1; i <= 1250; ++i) {
    const double turn = 2 * std::numbers::pi;
    const double t = 1e-3 * i;
    const Pull next{-3e-3 + 4e-3 * (1 - std::cos(turn * t)), 4e-3 * turn * std::sin(turn * t)};
    const double force = 150 * std::max(0.0, plant.position());
    const double before = plant.position();
    plant.advance(last, next, force, 1ms);
    out.summed += force * (plant.position() - before);
    last = next;
  }
  out.position = plant.position();
  out.work = plant.work();
  return out;
}

TEST(HandPlantTest, WorkIsTheSumOfForceTimesWay) {
  for (const Grip& grip : kGrips) {
    const Tapped tapped = tap_a_wall(grip, 100us);
    EXPECT_NEAR(tapped.work, tapped.summed, 1e-12);
    EXPECT_GT(std::abs(tapped.work), 1e-5);
  }
}

TEST(HandPlantTest, FinerStepsChangeTheMotionByLessThanHalfAPercent) {
  for (const Grip& grip : kGrips) {
    const Tapped coarse = tap_a_wall(grip, 100us);
    const Tapped fine = tap_a_wall(grip, 20us);
    EXPECT_NEAR(coarse.position, fine.position, 0.005 * std::abs(fine.position) + 1e-6);
    EXPECT_NEAR(coarse.work, fine.work, 0.02 * std::abs(fine.work));
  }
}

TEST(HandPlantTest, OnePartOrManyGiveTheSameSteps) {
  HandPlant whole{with(kMidGrip), 0};
  HandPlant parts{with(kMidGrip), 0};
  whole.advance({}, {}, 0.5, 1ms);
  for (int i = 0; i < 10; ++i) parts.advance({}, {}, 0.5, 100us);
  EXPECT_NEAR(whole.position(), parts.position(), 1e-15);
}

TEST(HandPlantTest, GripsHaveNames) {
  EXPECT_EQ(grip_named("light")->stiffness, 80);
  EXPECT_EQ(grip_named("arm")->mass, 0.3);
  for (const std::string_view name : kGripNames) EXPECT_TRUE(grip_named(name));
  EXPECT_EQ(grip_named("fist").error().text, "unknown grip 'fist'; there are: light mid firm arm");
}

}  // namespace
}  // namespace palp::surgeon
