#include "common/link/peer_clock.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

constexpr TimePoint at(Duration since_start) { return TimePoint{since_start}; }

TEST(RecentMinimumTest, ForgetsAfterSixteenSeconds) {
  RecentMinimum minimum;
  EXPECT_FALSE(minimum.least(at(0s)));
  minimum.add(3ms, at(500ms));
  minimum.add(5ms, at(2500ms));
  EXPECT_EQ(minimum.least(at(15999ms)), Duration{3ms});
  EXPECT_EQ(minimum.least(at(16s)), Duration{5ms});
  EXPECT_FALSE(minimum.least(at(18s)));
}

TEST(RecentMinimumTest, AnOldOneDoesNotReplaceANewerSecond) {
  RecentMinimum minimum;
  minimum.add(3ms, at(20s));
  minimum.add(1ms, at(4s));  // the same bin, a round before
  EXPECT_EQ(minimum.least(at(20s)), Duration{3ms});
}

RC_GTEST_PROP(RecentMinimumTest, AgreesWithALookThroughAll, ()) {
  RecentMinimum minimum;
  std::vector<std::pair<std::int64_t, Duration>> all;  // second, value
  std::int64_t milliseconds = 0;
  std::int64_t newest = 0;
  for (int i = 0; i < 200; ++i) {
    milliseconds = std::max<std::int64_t>(0, milliseconds + *rc::gen::inRange(-300, 2000));
    const Duration value{*rc::gen::inRange(-1000, 1000)};
    minimum.add(value, at(milliseconds * 1ms));
    all.emplace_back(milliseconds / 1000, value);
    newest = std::max(newest, milliseconds);
    const std::int64_t now = newest + (i % 3 == 0 ? 1500 : 0);
    std::optional<Duration> expected;
    for (const auto& [second, one] : all) {
      if (second > now / 1000 - 16) expected = std::min(expected.value_or(one), one);
    }
    RC_ASSERT(minimum.least(at(now * 1ms)) == expected);
  }
}

TEST(PeerClockTest, TakesTheHoldOffTheWay) {
  PeerClock clock;
  EXPECT_FALSE(clock.measured());
  EXPECT_TRUE(clock.add_round_trip(at(100ms), 7ms, at(150ms)));
  EXPECT_EQ(clock.smoothed(), Duration{43ms});
  EXPECT_EQ(clock.least(at(150ms)), Duration{43ms});
}

TEST(PeerClockTest, SmoothsByOneEighthAndOneQuarter) {
  PeerClock clock;
  ASSERT_TRUE(clock.add_round_trip(at(0ms), 0ms, at(80ms)));
  ASSERT_TRUE(clock.add_round_trip(at(100ms), 0ms, at(196ms)));
  EXPECT_EQ(clock.smoothed(), Duration{82ms});
  EXPECT_EQ(clock.deviation(), Duration{34ms});  // 40 + (16 - 40) / 4
  EXPECT_EQ(clock.least(at(196ms)), Duration{80ms});
}

TEST(PeerClockTest, RefusesTheImpossible) {
  PeerClock clock;
  EXPECT_FALSE(clock.add_round_trip(at(101ms), 0ms, at(100ms)));     // echo of the future
  EXPECT_FALSE(clock.add_round_trip(at(50ms), 50002us, at(100ms)));  // held longer than away
  EXPECT_TRUE(clock.add_round_trip(at(50ms), 50001us, at(100ms)));   // rounding of the hold
  EXPECT_EQ(clock.smoothed(), Duration{0});
}

TEST(PeerClockTest, OneWayExcessIsAgainstTheLeast) {
  PeerClock clock;
  EXPECT_EQ(clock.add_one_way(-5s, at(1s)), Duration{0});
  EXPECT_EQ(clock.add_one_way(-4900ms, at(2s)), Duration{100ms});
  EXPECT_EQ(clock.add_one_way(-5100ms, at(3s)), Duration{0});
  EXPECT_EQ(clock.add_one_way(-5s, at(4s)), Duration{100ms});
}

}  // namespace
}  // namespace palp::link
