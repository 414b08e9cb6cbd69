#include "video/standing_delay.h"

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace palp::video {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// Telegrams of 1 kHz for `span`, each so long on its way as `way` says.
template <class Way>
TimePoint pass(StandingDelay& delay, TimePoint from, Duration span, Way way) {
  static std::uint64_t number = 0;
  for (TimePoint at = from; at < from + span; at += milliseconds{1}) {
    delay.add(number++, way(at), at);
    (void)delay.read(at);
  }
  return from + span;
}

TEST(StandingDelayTest, IsWhatAQueueAddsWhateverTheClocksSay) {
  StandingDelay delay;
  const Duration clocks = -seconds{1000};
  TimePoint now = pass(delay, TimePoint{}, seconds{5}, [&](TimePoint) { return clocks; });
  EXPECT_EQ(delay.read(now).standing, Duration{0});
  now = pass(delay, now, milliseconds{300}, [&](TimePoint) { return clocks + milliseconds{12}; });
  const Duration standing = delay.read(now).standing;
  EXPECT_GT(standing, milliseconds{11});
  EXPECT_LE(standing, milliseconds{12});
}

TEST(StandingDelayTest, TheLinksOwnJitterTakesItselfOut) {
  StandingDelay delay;
  const RandomStream draws{1, 1};
  std::uint64_t i = 0;
  const auto jitter = [&](TimePoint) { return from_seconds(0.008 * std::abs(draws.normal(i++))); };
  TimePoint now{};
  Duration most{0};
  for (int step = 0; step < 300; ++step) {
    now = pass(delay, now, milliseconds{33}, jitter);
    if (step > 60) most = std::max(most, delay.read(now).standing);
  }
  EXPECT_LT(most, microseconds{1500});
}

TEST(StandingDelayTest, CountsWhatIsLost) {
  StandingDelay delay;
  for (std::uint64_t number = 0; number < 4000; ++number) {
    const TimePoint at{milliseconds{number}};
    if (number % 10 != 0) delay.add(number, Duration{0}, at);
    (void)delay.read(at);
  }
  const auto reading = delay.read(TimePoint{seconds{4}});
  const auto expected = static_cast<double>(reading.expected);
  EXPECT_NEAR(expected, 2000, 100);
  EXPECT_NEAR(static_cast<double>(reading.arrived) / expected, 0.9, 0.01);
}

TEST(StandingDelayTest, NothingHeardSaysNothing) {
  StandingDelay delay;
  EXPECT_EQ(delay.read(TimePoint{seconds{5}}).standing, Duration{0});
  EXPECT_EQ(delay.read(TimePoint{seconds{5}}).expected, 0U);
}

}  // namespace
}  // namespace palp::video
