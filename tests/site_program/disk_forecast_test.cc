#include "site_program/disk_forecast.h"

#include <rapidcheck/gtest.h>

namespace palp::site_program {
namespace {

using std::chrono::seconds;

constexpr std::uint64_t kMega = 1'000'000;  // [bytes]

TimePoint at(int second) { return TimePoint{} + seconds{1000 + second}; }

RC_GTEST_PROP(DiskForecastTest, ASteadyRateEndsWhenItWasForeseen, ()) {
  const auto rate = *rc::gen::inRange<std::uint64_t>(1'000, 1'000'000);
  const auto room = *rc::gen::inRange<std::uint64_t>(100 * kMega, 10'000 * kMega);
  DiskForecast forecast;
  for (int second = 0; second < 60; ++second) {
    const std::uint64_t written = rate * static_cast<std::uint64_t>(second);
    forecast.look(at(second), written, room - written);
    if (second < 2) continue;
    RC_ASSERT(forecast.left());
    const double ends = static_cast<double>(second) + palp::seconds(*forecast.left());
    const double foreseen = static_cast<double>(room) / static_cast<double>(rate);
    RC_ASSERT(std::abs(ends - std::min(foreseen, 1e7 + second)) < 1e-3 * foreseen);
  }
}

TEST(DiskForecastTest, WhatOthersWriteCounts) {
  DiskForecast forecast;
  for (int second = 0; second <= 10; ++second) {
    forecast.look(at(second), 0, (100 - static_cast<std::uint64_t>(second)) * kMega);
  }
  ASSERT_TRUE(forecast.left());
  EXPECT_NEAR(palp::seconds(*forecast.left()), 90, 1);
}

TEST(DiskForecastTest, AnHourOfQuietDoesNotHideAFlood) {
  DiskForecast forecast;
  int second = 0;
  for (; second < 3600; ++second) forecast.look(at(second), 0, 10'000 * kMega);
  EXPECT_FALSE(forecast.left()) << "nothing is written";
  std::uint64_t room = 10'000 * kMega;
  for (int i = 0; i < 30; ++i) forecast.look(at(second++), 0, room -= 100 * kMega);
  ASSERT_TRUE(forecast.left());
  EXPECT_LT(palp::seconds(*forecast.left()), 75);
}

TEST(DiskForecastTest, AFullDiskHasNoTimeLeft) {
  DiskForecast forecast;
  for (int second = 0; second <= 5; ++second) {
    forecast.look(at(second), static_cast<std::uint64_t>(second) * kMega, 0);
  }
  EXPECT_EQ(forecast.left(), Duration{0});
}

}  // namespace
}  // namespace palp::site_program
