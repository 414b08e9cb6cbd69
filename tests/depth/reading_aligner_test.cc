#include "depth/reading_aligner.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace palp::depth {
namespace {

constexpr Duration kTick = std::chrono::milliseconds{1};

constexpr double kWay = 12e-6;  // [m]; straight lines over 20 ms miss it by 18 um

double tip_of(TimePoint at) {  // [m]
  return 4e-3 * std::sin(2 * std::numbers::pi * 1.5 * seconds(at.time_since_epoch()));
}
double force_of(TimePoint at) { return 100 * tip_of(at) + 0.3; }  // [N]

/// A site of 1 kHz whose devices are read every so often, each reading `late` when it comes.
struct Site {
  Duration stage_period{kTick};
  Duration sensor_period{kTick};
  Duration late{};
  TimePoint silent_from{TimePoint::max()};  ///< of the stage ...
  TimePoint silent_to{};                    ///< ... until then

  [[nodiscard]] std::vector<AlignedSample> run(int ticks) const {
    ReadingAligner aligner{
        {.stage_rate = 1 / seconds(stage_period), .sensor_rate = 1 / seconds(sensor_period)}};
    std::vector<AlignedSample> out;
    for (int i = 200; i < 200 + ticks; ++i) {
      const TimePoint now{i * kTick};
      const auto newest = [&](Duration period) {
        return TimePoint{(now - late).time_since_epoch() / period * period};
      };
      TimePoint tip_at = newest(stage_period);
      if (tip_at > silent_from && tip_at < silent_to) tip_at = silent_from;
      const TimePoint force_at = newest(sensor_period);
      aligner.add({.at = now,
                   .position = tip_of(tip_at),
                   .force = force_of(force_at),
                   .place = {},
                   .position_age = now - tip_at,
                   .force_age = now - force_at});
      while (const auto one = aligner.take()) out.push_back(*one);
    }
    return out;
  }
};

TEST(ReadingAlignerTest, DevicesThatReadAtEveryTickPassUnchanged) {
  const auto samples = Site{}.run(500);
  ASSERT_EQ(samples.size(), 500);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const TimePoint at{(200 + static_cast<int>(i)) * kTick};
    EXPECT_EQ(samples[i].sample.at, at);
    EXPECT_EQ(samples[i].sample.position, tip_of(at));
    EXPECT_EQ(samples[i].sample.force, force_of(at));
    EXPECT_TRUE(samples[i].read);
  }
}

TEST(ReadingAlignerTest, TipAndForceAreOfOneInstantWhateverTheirRatesAndAges) {
  using std::chrono::milliseconds;
  for (const auto& [stage, sensor, late] :
       {std::tuple{5, 10, 2}, {20, 20, 3}, {20, 1, 0}, {1, 20, 7}, {7, 3, 1}, {3, 7, 0}}) {
    const Site site{milliseconds{stage}, milliseconds{sensor}, milliseconds{late}};
    const auto samples = site.run(1000);
    ASSERT_GT(samples.size(), 900);
    std::size_t readings = 0;
    TimePoint before{};
    for (const AlignedSample& one : samples) {
      EXPECT_NEAR(one.sample.position, tip_of(one.sample.at), kWay) << stage;
      EXPECT_NEAR(one.sample.force, force_of(one.sample.at), one.read ? 1e-12 : 2e-3) << sensor;
      if (before != TimePoint{}) {
        EXPECT_LE(one.sample.at - before, std::chrono::microseconds{1500});
      }
      EXPECT_GT(one.sample.at, before);
      before = one.sample.at;
      readings += one.read ? 1 : 0;
    }
    EXPECT_NEAR(
        static_cast<double>(readings), 1000.0 / sensor, (2.0 * stage + late + 5) / sensor + 2)
        << "each reading counts once";
  }
}

TEST(ReadingAlignerTest, WhatLiesInASilenceOfTheStageIsNotInvented) {
  const TimePoint from{std::chrono::milliseconds{500}};
  const TimePoint to{std::chrono::milliseconds{620}};
  const Site site{std::chrono::milliseconds{5}, kTick, {}, from, to};
  for (const AlignedSample& one : site.run(800)) {
    EXPECT_FALSE(one.sample.at > from && one.sample.at < to);
    EXPECT_NEAR(one.sample.position, tip_of(one.sample.at), kWay);
  }
}

}  // namespace
}  // namespace palp::depth
