#include "common/coupling/paired_readings.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp::coupling {
namespace {

using std::chrono::milliseconds;

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kSpeed = 0.05;   // [m/s], of the tip
constexpr double kStiff = 400;    // [N/m]

PatientDevices devices(double stage_rate, double sensor_rate, double hidden) {
  PatientDevices facts;
  facts.stage.rate = stage_rate;
  facts.sensor.rate = sensor_rate;
  facts.sensor.lag += hidden;
  return facts;
}

double tip_at(TimePoint at) { return kSpeed * seconds(at.time_since_epoch()); }

/// Runs a tip that moves evenly on a spring, read at the devices' paces.
/// @returns the largest error of a pair against the spring [N].
double worst_pair(const PatientDevices& facts, Duration stage, Duration sensor, Duration hidden) {
  PairedReadings paired{facts, kPeriod};
  TimePoint stood_at{};
  TimePoint felt_at{};
  double worst = 0;
  for (int tick = 1000; tick < 1600; ++tick) {
    const TimePoint now{milliseconds{tick}};
    if (tick % (stage / milliseconds{1}) == 0) stood_at = now;
    if (tick % (sensor / milliseconds{1}) == 0) felt_at = now;
    const auto pair =
        paired.step(now, stood_at, tip_at(stood_at), felt_at, kStiff * tip_at(felt_at - hidden));
    if (tick > 1200) worst = std::max(worst, std::abs(pair.force - kStiff * pair.position));
  }
  return worst;
}

TEST(PairedReadingsTest, DevicesOfEachTickArePairedAsTheyAre) {
  PairedReadings paired{PatientDevices{}, kPeriod};
  EXPECT_EQ(paired.late(), 0);
  const TimePoint now{milliseconds{7}};
  const auto pair = paired.step(now, now, 1e-3, now - milliseconds{3}, 0.5);
  EXPECT_EQ(pair.position, 1e-3);
  EXPECT_EQ(pair.force, 0.5);
}

TEST(PairedReadingsTest, PairsOfSlowAndLateDevicesLieOnTheSpring) {
  const double as_they_come = kStiff * kSpeed * 20e-3;
  EXPECT_LT(worst_pair(devices(50, 1000, 0), milliseconds{20}, milliseconds{1}, {}),
            as_they_come / 100);
  EXPECT_LT(worst_pair(devices(1000, 50, 0), milliseconds{1}, milliseconds{20}, {}),
            as_they_come / 100);
  EXPECT_LT(
      worst_pair(devices(200, 100, 20e-3), milliseconds{5}, milliseconds{10}, milliseconds{20}),
      as_they_come / 100);
}

TEST(PairedReadingsTest, ASensorThatFallsSilentLeavesItsLastPairStanding) {
  PairedReadings paired{devices(200, 200, 0), kPeriod};
  PairedReadings::Pair pair;
  for (int tick = 0; tick < 500; ++tick) {
    const TimePoint now{milliseconds{1000 + tick}};
    pair = paired.step(now, now, tip_at(now), TimePoint{milliseconds{1000}}, 0.5);
  }
  EXPECT_EQ(pair.force, 0.5);
  EXPECT_TRUE(std::isfinite(pair.position));
}

}  // namespace
}  // namespace palp::coupling
