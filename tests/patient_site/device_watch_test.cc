#include "patient_site/device_watch.h"

#include <gtest/gtest.h>

namespace palp::patient {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

/// A tip that goes in at 100 mm/s, and a sensor that reads each 20 ms.
class SlowSensor {
 public:
  DeviceWatch::Stuck tick(bool works) {
    now_ += kTick;
    look_.tip += 1e-4;
    look_.target = look_.tip;
    if (++ticks_ % 20 == 0) {
      look_.felt_at = now_;
      if (works) look_.force += 0.1;
    }
    look_.at = now_;
    return watch_.judge(look_, lapse_);
  }

 private:
  DeviceWatch watch_{{}};
  DeviceWatch::Look look_{.force = 0.2, .in_tissue = true, .follows = true};
  Lapse lapse_{kTick};
  TimePoint now_{};
  int ticks_{};
};

TEST(DeviceWatchTest, AReadingMayStandForTheWayOfSomeOfTheSensorsPeriods) {
  SlowSensor sensor;
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(sensor.tick(true).sensor) << i;
  int after = 0;
  while (!sensor.tick(false).sensor && after < 1000) ++after;
  EXPECT_NEAR(after, 100, 20) << "the fifth reading that is the same";
}

/// Millisecond by millisecond, a sensor that reads each of them.
class QuickSensor {
 public:
  /// @returns whether the sensor was found stuck within `count` ticks of this force [N] at a tip
  /// that moves at `speed` [m/s].
  template <class Force>
  bool stuck_within(int count, double speed, const Force& force) {
    bool stuck = false;
    for (int i = 0; i < count; ++i) {
      look_.at = look_.felt_at = look_.at + kTick;
      look_.tip += 1e-3 * speed;
      look_.target = look_.tip;
      look_.force = force(i);
      stuck = watch_.judge(look_, kTick).sensor || stuck;
    }
    return stuck;
  }
  DeviceWatch::Look look_{.in_tissue = true, .follows = true};

 private:
  DeviceWatch watch_{{}};
};

double noise(int i) { return 8e-3 * ((i * 7919) % 13 - 6) / 6.0; }  // [N]

TEST(DeviceWatchTest, AReadingThatTogglesIsAsStuckAsOneThatStays) {
  QuickSensor sensor;
  EXPECT_TRUE(sensor.stuck_within(100, 0.05, [](int i) { return 0.6 + 1e-3 * (i % 2); }));
  QuickSensor soft;  // 40 N/m
  EXPECT_FALSE(soft.stuck_within(100, 0.05, [](int i) { return 0.1 + 40 * 5e-5 * i; }));
}

TEST(DeviceWatchTest, AForceThatVanishesUnderATipThatStaysIsNone) {
  QuickSensor sensor;
  EXPECT_FALSE(sensor.stuck_within(300, 0, [](int i) { return 0.9 + noise(i); }));
  EXPECT_TRUE(sensor.stuck_within(150, 0.01, noise));
}

TEST(DeviceWatchTest, ATipThatLeavesOrASurfaceThatBreathesEndsAForce) {
  QuickSensor leaves;
  (void)leaves.stuck_within(100, 0, [](int i) { return 0.9 + noise(i); });
  EXPECT_FALSE(leaves.stuck_within(20, -0.05, [](int i) { return 0.9 * (1 - i / 20.0); }));
  EXPECT_FALSE(leaves.stuck_within(300, 0, noise));

  QuickSensor breathes;
  (void)breathes.stuck_within(100, 0, [](int i) { return 0.9 + noise(i); });
  EXPECT_FALSE(breathes.stuck_within(80, 0, [](int i) { return 0.9 * (1 - i / 80.0); }));
  EXPECT_FALSE(breathes.stuck_within(300, 0, noise));
}

TEST(DeviceWatchTest, OneReadingThatIsMissingIsNoEndOfAForce) {
  QuickSensor sensor;
  const auto gaps = [](int i) { return i % 20 == 0 ? 0.0 : 0.9 + noise(i); };
  EXPECT_FALSE(sensor.stuck_within(1000, 0, gaps));
}

TEST(DeviceWatchTest, AStageIsJudgedInEveryStateASensorWhereTheLawIsFollowed) {
  QuickSensor parked;
  parked.look_.follows = false;
  EXPECT_FALSE(parked.stuck_within(300, 0.05, [](int) { return 0.6; }));

  DeviceWatch watch{{}};
  bool stuck = false;
  for (int i = 0; i < 302; ++i) {
    stuck = watch.judge({.tip = 2e-3 + 1e-5 * i, .target = 0}, kTick).stage;
  }
  EXPECT_TRUE(stuck);
}

}  // namespace
}  // namespace palp::patient
