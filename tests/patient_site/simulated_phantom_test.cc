#include "patient_site/simulated_phantom.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

const Phantom& soft() {
  static const Phantom phantom = *make_phantom("paper-10mm");
  return phantom;
}

/// Moves to a position and stays for a while; the last force.
double press(SimulatedPhantom& site, TimePoint& now, double position, const Place& place = kSiteB) {
  double force = 0;
  for (int i = 0; i < 1000; ++i) {
    site.move_to({position, place});
    now += kTick;
    (void)site.read(now);
    force = site.sample(now)->force;
  }
  return force;
}

TEST(SimulatedPhantomTest, HoldsTheTablesForceAtRest) {
  SimulatedPhantomConfig config = ideal_sensor();
  config.surface_offset = 1.7e-3;
  SimulatedPhantom site{soft(), config};
  TimePoint now{};
  EXPECT_NEAR(press(site, now, 4.7e-3), soft().over.force(3e-3), 1e-6);
  EXPECT_NEAR(press(site, now, 4.7e-3, kSiteA), soft().plain.force(3e-3), 1e-6);
  EXPECT_NEAR(press(site, now, 1.0e-3), 0, 1e-12);
}

TEST(SimulatedPhantomTest, KeepsSpeedAndAcceleration) {
  SimulatedPhantomConfig config;
  SimulatedPhantom site{soft(), config};
  TimePoint now{};
  double before = 0;
  double fastest = 0;
  (void)site.read(now);
  for (int i = 0; i < 400; ++i) {
    site.move_to({20e-3, {}});
    now += kTick;
    (void)site.read(now);
    EXPECT_LE(std::abs(site.truth().velocity - before), 8.001e-3);
    before = site.truth().velocity;
    fastest = std::max(fastest, before);
  }
  EXPECT_NEAR(fastest, 0.15, 1e-6);
}

TEST(SimulatedPhantomTest, ReadingTwiceAtOneInstantAdvancesOnce) {
  SimulatedPhantom once{soft(), {}};
  SimulatedPhantom twice{soft(), {}};
  TimePoint now{};
  for (int i = 0; i < 300; ++i) {
    now += kTick;
    for (SimulatedPhantom* site : {&once, &twice}) site->move_to({2e-3, kSiteB});
    (void)twice.sample(now);
    (void)twice.read(now);
    EXPECT_EQ(once.read(now).position, twice.read(now).position);
    EXPECT_EQ(once.sample(now)->force, twice.sample(now)->force);
  }
}

TEST(SimulatedPhantomTest, TheSensorLagsBy20Hz) {
  SimulatedPhantomConfig config = ideal_sensor();
  config.surface_offset = -10e-3 - 2e-3;  // starts 2 mm deep
  SimulatedPhantom site{soft(), config};
  TimePoint now{};
  (void)site.read(now);
  const double full = soft().plain.force(2e-3);
  site.move_to({-10e-3, {}});
  now += std::chrono::microseconds{7958};  // one time constant of 20 Hz, in whole steps of 0.1 ms
  EXPECT_NEAR(site.sample(now)->force / full, 1 - std::exp(-1.0), 0.01);
}

TEST(SimulatedPhantomTest, NoiseIsSmallWhiteAndRepeatable) {
  SimulatedPhantomConfig config;
  config.force_quantum = 0;
  SimulatedPhantom a{soft(), config};
  SimulatedPhantom b{soft(), config};
  config.seed = 2;
  SimulatedPhantom c{soft(), config};
  double squares = 0;
  int differ = 0;
  TimePoint now{};
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    now += kTick;
    const double force = a.sample(now)->force;
    EXPECT_EQ(force, b.sample(now)->force);
    differ += force != c.sample(now)->force ? 1 : 0;
    squares += force * force;
  }
  EXPECT_NEAR(std::sqrt(squares / kCount), 0.015, 0.001);
  EXPECT_EQ(differ, kCount);
}

TEST(SimulatedPhantomTest, ForceComesInSteps) {
  SimulatedPhantom site{soft(), {}};
  TimePoint now{};
  for (int i = 0; i < 500; ++i) {
    site.move_to({3e-3, kSiteB});
    now += kTick;
    const double steps = site.sample(now)->force / 0.05;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
}

TEST(SimulatedPhantomTest, ARisingIndentationMeetsMoreForceAndCostsEnergy) {
  SimulatedPhantomConfig config;
  config.force_noise = 0;
  SimulatedPhantom site{soft(), config};
  TimePoint now{};
  (void)press(site, now, 3e-3);
  const double stored = site.truth().tissue_energy;
  EXPECT_GT(stored, 0);
  (void)press(site, now, -3e-3);
  const double lost = site.truth().tissue_energy;
  EXPECT_GT(lost, 0) << "damping takes energy, tissue never gives more than it took";
  EXPECT_LT(lost, 0.2 * stored);
}

TEST(SimulatedPhantomTest, ABreathingSurfaceMovesTheForce) {
  SimulatedPhantomConfig config = ideal_sensor();
  config.breathing_amplitude = 1e-3;
  config.breathing_frequency = 0.25;
  SimulatedPhantom site{soft(), config};
  TimePoint now{};
  double low = 1;
  double high = 0;
  (void)press(site, now, 2e-3);
  for (int i = 0; i < 4000; ++i) {
    now += kTick;
    const double force = site.sample(now)->force;
    low = std::min(low, force);
    high = std::max(high, force);
  }
  EXPECT_NEAR(low, soft().over.force(1e-3), 1e-3);
  EXPECT_NEAR(high, soft().over.force(3e-3), 1e-3);
}

TEST(SimulatedPhantomTest, ATargetThatIsNoNumberIsAHalt) {
  SimulatedPhantom site{soft(), {}};
  TimePoint now{};
  (void)press(site, now, 1e-3);
  site.move_to({std::nan(""), {}});
  for (int i = 0; i < 100; ++i) (void)site.read(now += kTick);
  EXPECT_NEAR(site.truth().position, 1e-3, 1e-5);
}

TEST(SimulatedPhantomTest, HalfTheStepsGiveTheSameMotion) {
  // Ticks of 1 ms and of 0.5 ms: the plant's own step does not depend on who asks how often.
  SimulatedPhantom coarse{soft(), {}};
  SimulatedPhantom fine{soft(), {}};
  TimePoint now{};
  (void)coarse.read(now);
  (void)fine.read(now);
  coarse.move_to({2e-3, {}});
  fine.move_to({2e-3, {}});
  for (int i = 0; i < 200; ++i) {
    (void)fine.read(now + kTick / 2);
    now += kTick;
    EXPECT_EQ(coarse.read(now).position, fine.read(now).position);
  }
}

}  // namespace
}  // namespace palp::patient
