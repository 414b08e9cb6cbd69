#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "patient_site/simulated_phantom.h"
#include "tests/depth/tapping.h"

// Goal: the contact moves the simulated stage and what it carries, as it moves real ones. Method: a
// spring, whose every balance is known, and tissues along random ways.

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A tissue of `stiffness` [N/m] at every depth, to 50 mm.
Phantom spring(double stiffness) {
  std::vector<ForceRow> rows;
  for (int i = 0; i <= 10; ++i) rows.push_back({i * 5e-3, i * 5e-3 * stiffness});
  const ForceTable table = *ForceTable::make(rows);
  return {.name = "spring",
          .plain = table,
          .over = table,
          .depth = {},
          .radius = {},
          .ratio = {},
          .shape = "none"};
}

void move(SimulatedPhantom& site, TimePoint& now, double target, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    site.move_to({target, {}});
    (void)site.read(now += kTick);
  }
}

double omega_of(const SimulatedPhantomConfig& config) {
  return 2 * std::numbers::pi * config.servo_frequency;
}

/// What nothing moves is the sum it always was, to the last bit.
TEST(StageYieldTest, WhatDoesNotYieldIsTheBareServo) {
  const Phantom phantom = *make_phantom("relaxing:10");
  const SimulatedPhantomConfig config;
  SimulatedPhantom site{phantom, config};
  const auto field = make_field(phantom, config.viscous_factor);
  RelaxingForce relaxing{phantom.relaxation};
  TimePoint now{};
  (void)site.read(now);
  double position = config.start_position;
  double velocity = 0;
  double energy = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    const double target = tick < 700 ? 4e-3 : -1e-3;
    move(site, now, target, 1);
    for (int step = 0; step < 10; ++step) {
      const double omega = omega_of(config);
      const double pull =
          omega * omega * (target - position) - 2 * config.servo_damping * omega * velocity;
      velocity = std::clamp(velocity + std::clamp(pull, -8.0, 8.0) * 1e-4, -0.15, 0.15);
      position += velocity * 1e-4;
      const double elastic = relaxing.step(field->elastic_force({}, position), 1e-4);
      const double force = std::max(0.0, elastic * field->growth(velocity));
      energy += force * velocity * 1e-4;
      if (step == 9) {
        EXPECT_EQ(site.truth().contact_force, force);
      }
    }
    EXPECT_EQ(site.truth().position, position);
    EXPECT_EQ(site.truth().velocity, velocity);
    EXPECT_EQ(site.truth().tissue_energy, energy);
  }
  EXPECT_GT(energy, 0);
}

TEST(StageYieldTest, AServoGivesWayByTheForceOverItsStiffness) {
  for (const double servo : {10e3, 100e3, 10e6}) {
    SimulatedPhantomConfig config = ideal_sensor();
    config.servo_stiffness = servo;
    config.encoder_step = 0;
    const Phantom phantom = spring(1000);
    SimulatedPhantom site{phantom, config};
    TimePoint now{};
    move(site, now, 3e-3, 2000);
    const double force = site.truth().contact_force;
    EXPECT_NEAR(site.read(now).position, 3e-3 - force / servo, 1e-9) << "the encoder sees it";
    EXPECT_NEAR(force, 3e-3 / (1e-3 + 1 / servo), 1e-6);
  }
}

TEST(StageYieldTest, TheMotorsLimitIsNotTheTissues) {
  SimulatedPhantomConfig config;
  config.servo_stiffness = 1e3;
  const Phantom phantom = spring(1000);
  SimulatedPhantom site{phantom, config};
  TimePoint now{};
  move(site, now, 4e-3, 3000);
  const double pull_max =
      config.servo_stiffness * config.acceleration_max / (omega_of(config) * omega_of(config));
  double most = 0;
  double least = 10;
  for (int i = 0; i < 500; ++i) {
    move(site, now, 4e-3, 1);
    most = std::max(most, site.truth().contact_force);
    least = std::min(least, site.truth().contact_force);
  }
  EXPECT_NEAR((most + least) / 2, pull_max, 0.05 * pull_max) << "it pushes no harder for long";
  EXPECT_LT(pull_max, 0.51);
}

TEST(StageYieldTest, AHaltedServoHoldsAgainstWhatPresses) {
  SimulatedPhantomConfig config;
  config.servo_stiffness = 10e3;
  const Phantom phantom = spring(1000);
  SimulatedPhantom site{phantom, config};
  TimePoint now{};
  move(site, now, 2e-3, 1000);
  const double stood = site.truth().position;
  for (int i = 0; i < 5000; ++i) {
    site.halt();
    (void)site.read(now += kTick);
  }
  EXPECT_NEAR(site.truth().position, stood, 1e-6);
}

TEST(StageYieldTest, SpringsInARowShareTheWay) {
  for (const double product : {0.01, 0.5, 2.0, 10.0, 100.0}) {
    const double stiffness = 5000;
    SimulatedPhantomConfig config;
    config.encoder_step = 0;
    config.yield = product / stiffness;
    const Phantom phantom = spring(stiffness);
    SimulatedPhantom site{phantom, config};
    TimePoint now{};
    for (int i = 0; i < 200; ++i) {
      move(site, now, 3e-3, 1);
      EXPECT_NEAR(site.truth().position,
                  site.read(now).position - config.yield * site.truth().contact_force,
                  2e-9)
          << "on the way too, where the force depends on the speed";
    }
    move(site, now, 3e-3, 3000);
    const PhantomTruth truth = site.truth();
    const double series = 1 / (1 / stiffness + config.yield);
    EXPECT_NEAR(truth.contact_force / (3e-3 * series), 1, 1e-6) << product;
    EXPECT_NEAR(truth.position, 3e-3 - config.yield * truth.contact_force, 1e-9);
    EXPECT_NEAR(truth.velocity, 0, 1e-8) << "and it stands still";
  }
}

/// Relaxation and the viscous term too: the limit is no other law.
TEST(StageYieldTest, AYieldThatGoesToNothingIsNone) {
  const Phantom phantom = *make_phantom("relaxing:10");
  SimulatedPhantomConfig config;
  config.breathing_amplitude = 0.5e-3;
  config.breathing_frequency = 2;
  SimulatedPhantom rigid{phantom, config};
  config.yield = 1e-9;
  SimulatedPhantom nearly{phantom, config};
  TimePoint now{};
  double most = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    now += kTick;
    for (SimulatedPhantom* site : {&rigid, &nearly}) {
      site->move_to({tick / 400 % 2 == 0 ? 4e-3 : -1e-3, kSiteB});
      (void)site->read(now);
    }
    most = std::max(most, rigid.truth().contact_force);
    EXPECT_NEAR(nearly.truth().contact_force, rigid.truth().contact_force, 1e-5);
    EXPECT_NEAR(nearly.truth().position, rigid.truth().position, 1e-8);
  }
  EXPECT_GT(most, 0.3);
}

/// Along random ways and through any yield an elastic tissue holds what it took: what went in is no
/// less than what it stores, and little more.
TEST(StageYieldTest, AnElasticTissueGivesBackNoMoreThanItTook) {
  for (const double yield : {0.0, 20e-6, 1e-3, 20e-3}) {
    constexpr double kStiffness = 2000;
    SimulatedPhantomConfig config = ideal_sensor();
    config.yield = yield;
    config.servo_stiffness = yield > 0 ? 20e3 : 0;
    const Phantom phantom = spring(kStiffness);
    SimulatedPhantom site{phantom, config};
    TimePoint now{};
    double most = 0;
    for (std::uint64_t leg = 0; leg < 200; ++leg) {
      const double target = 1e-3 + 1.5e-3 * random_normal(7, 1, leg);
      for (int i = 0; i < 20; ++i) {
        move(site, now, target, 1);
        const PhantomTruth truth = site.truth();
        const double stored = 0.5 * truth.contact_force * truth.contact_force / kStiffness;
        EXPECT_GE(truth.tissue_energy, stored - 1e-12) << yield;
        most = std::max(most, stored);
      }
    }
    move(site, now, -2e-3, 1000);
    EXPECT_EQ(site.truth().contact_force, 0);
    EXPECT_LT(site.truth().tissue_energy, 10 * most) << "200 legs lose little";
  }
}

TEST(StageYieldTest, WhatWentInIsWhatTheTissueStoresNotWhatTheSensorDoes) {
  SimulatedPhantomConfig config = ideal_sensor();
  config.yield = 1e-3;
  const Phantom phantom = spring(2000);
  SimulatedPhantom site{phantom, config};
  TimePoint now{};
  for (int i = 0; i < 2000; ++i) move(site, now, -1e-3 + i * 2e-6, 1);
  const PhantomTruth truth = site.truth();
  const double stored = 0.5 * truth.contact_force * truth.contact_force / 2000;
  EXPECT_NEAR(truth.tissue_energy / stored, 1, 0.01);
}

TEST(StageYieldTest, AgainstASpringAStandingTargetIsStoodAt) {
  for (const double stiffness : {200.0, 1000.0, 2000.0}) {
    for (const double servo : {0.0, 10e3, 100e3, 10e6}) {
      for (const double yield : {0.0, 20e-6, 1e-3}) {
        SimulatedPhantomConfig config;
        config.servo_stiffness = servo;
        config.yield = yield;
        const Phantom phantom = spring(stiffness);
        SimulatedPhantom site{phantom, config};
        TimePoint now{};
        move(site, now, 1e-3, 2000);
        const double stood = site.truth().position;
        for (int i = 0; i < 200; ++i) {
          move(site, now, 1e-3, 1);
          EXPECT_NEAR(site.truth().position, stood, 1e-10) << stiffness << ' ' << servo;
        }
        EXPECT_GT(site.truth().contact_force, 0.05);
      }
    }
  }
}

TEST(StageYieldTest, TheSensorSaysHowFarItYields) {
  SimulatedPhantomConfig config;
  EXPECT_EQ(facts_of(config).sensor.yield, 0);
  config.yield = 20e-6;
  EXPECT_EQ(facts_of(config).sensor.yield, 20e-6);
  config.yield_stated = 0.5;
  EXPECT_EQ(facts_of(config).sensor.yield, 10e-6);
}

}  // namespace
}  // namespace palp::patient
