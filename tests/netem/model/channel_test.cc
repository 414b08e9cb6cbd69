#include "netem/model/channel.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/link/transport.h"
#include "tests/netem/model/impairment_builders.h"
#include "tests/netem/model/impairment_generators.h"

namespace palp::netem {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

using Buffer = std::array<std::byte, link::kDatagramSizeMax>;

TimePoint at_ms(std::int64_t milliseconds_since_start) {
  return TimePoint{milliseconds{milliseconds_since_start}};
}

/// A datagram that says its number; its size depends on it.
std::vector<std::byte> numbered(std::uint64_t number) {
  std::vector<std::byte> datagram(sizeof number + number % 300, std::byte{0x5a});
  std::memcpy(datagram.data(), &number, sizeof number);
  return datagram;
}

std::uint64_t number_of(const Buffer& buffer) {
  std::uint64_t number = 0;
  std::memcpy(&number, buffer.data(), sizeof number);
  return number;
}

std::uint64_t accounted(const Channel& channel) {
  const ChannelCounters& counters = channel.counters();
  return counters.popped + counters.lost + counters.header_hit + counters.blackout +
         counters.over_limit + channel.in_flight();
}

RC_GTEST_PROP(ChannelTest, ConservesDatagrams, ()) {
  const Impairment impairment = make_impairment(milliseconds{100});
  const std::size_t in_flight_max = *rc::gen::inRange<std::size_t>(1, 200);
  Channel channel{impairment, *rc::gen::arbitrary<std::uint64_t>(), Direction::Down, in_flight_max};
  Buffer buffer{};
  TimePoint now{};
  std::uint64_t pushed = 0;
  for (int step = 0; step < 200; ++step) {
    now += *rc::gen::map(rc::gen::inRange(0, 3000), [](int us) { return microseconds{us}; });
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) channel.push(numbered(pushed++), now);
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
      const auto released = channel.pop(buffer, now);
      if (!released) break;
      RC_ASSERT(released->released_at <= now);
      RC_ASSERT(released->released_at >= released->arrived_at);
      const Decision& decision = released->decision;
      const bool whole = impairment.truncate == Chance{};
      if (whole) RC_ASSERT(released->size == numbered(released->index).size());
      if (whole && decision.flipped_bit < 0) RC_ASSERT(number_of(buffer) == released->index);
    }
    RC_ASSERT(channel.counters().pushed == pushed);
    RC_ASSERT(channel.counters().pushed + channel.counters().copies == accounted(channel));
  }
}

/// What came out, in order: number, duplicate, release.
struct Leaving {
  std::uint64_t index{};
  bool duplicate{};
  TimePoint release{};
  bool operator==(const Leaving&) const = default;
};

struct Log {
  std::vector<Leaving> leaving;
  ChannelCounters counters;
};

/// One datagram a millisecond for 3 s, collected every `poll`; 0: once, at the end of all.
Log run(const Impairment& impairment, Duration poll, std::size_t in_flight_max = 4096) {
  Channel channel{impairment, 7, Direction::Up, in_flight_max};
  Log log;
  Buffer buffer{};
  const auto collect = [&](TimePoint now) {
    while (const auto released = channel.pop(buffer, now)) {
      log.leaving.push_back({released->index, released->duplicate, released->released_at});
    }
  };
  TimePoint polled{};
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const TimePoint now = at_ms(static_cast<std::int64_t>(i));
    for (; poll > Duration{} && polled < now; polled += poll) collect(polled);
    channel.push(numbered(i), now);
  }
  collect(at_ms(100'000));
  log.counters = channel.counters();
  return log;
}

constexpr const char* kHarsh =
    "delay 30ms 10ms distribution normal loss 5% loss burst 1/s 50ms duplicate 5% "
    "blackout 1s 100ms order free";

TEST(ChannelTest, ReleasesTheSameHoweverOftenItIsPolled) {
  const Log coarse = run(impaired(kHarsh), milliseconds{1});
  const Log fine = run(impaired(kHarsh), microseconds{100});
  const Log odd = run(impaired(kHarsh), microseconds{7300});
  EXPECT_GT(coarse.leaving.size(), 2000U);
  EXPECT_EQ(coarse.leaving, fine.leaving);
  EXPECT_EQ(coarse.leaving, odd.leaving);
}

TEST(ChannelTest, LimitCountsWhatIsOnItsWayNotWhatWaitsToBeCollected) {
  // 30 ms of delay at 1 kHz need about 30 places: with 20 a third is refused, polled or not.
  const Log coarse = run(impaired(kHarsh), milliseconds{1}, 20);
  const Log fine = run(impaired(kHarsh), microseconds{100}, 20);
  const Log odd = run(impaired(kHarsh), microseconds{7300}, 20);
  EXPECT_GT(coarse.counters.over_limit, 500U);
  EXPECT_EQ(coarse.leaving, fine.leaving);
  EXPECT_EQ(coarse.leaving, odd.leaving);
  EXPECT_EQ(coarse.counters.over_limit, odd.counters.over_limit);
}

TEST(ChannelTest, HoldsExactlyItsLimit) {
  Channel channel{impaired("delay 10ms"), 1, Direction::Up, 5};
  for (std::uint64_t i = 0; i < 5; ++i) channel.push(numbered(i), at_ms(0));
  EXPECT_EQ(channel.counters().over_limit, 0U);
  channel.push(numbered(5), at_ms(9));
  EXPECT_EQ(channel.counters().over_limit, 1U);
  channel.push(numbered(6), at_ms(10));  // the five are due now and no longer on their way
  EXPECT_EQ(channel.counters().over_limit, 1U);
  EXPECT_EQ(channel.in_flight(), 6U);
}

TEST(ChannelTest, LimitCountsWhatWasCollectedBeforeTheClockOfArrivalsGotThere) {
  // A relay learns of an arrival late, by its stamp: by then it may have sent what was still on
  // its way at that instant.
  Channel channel{impaired("delay 10ms"), 1, Direction::Up, 1};
  Buffer buffer{};
  channel.push(numbered(0), at_ms(0));
  EXPECT_TRUE(channel.pop(buffer, at_ms(12)));
  channel.push(numbered(1), at_ms(9));
  EXPECT_EQ(channel.counters().over_limit, 1U);
  channel.push(numbered(2), at_ms(10));
  EXPECT_EQ(channel.counters().over_limit, 1U);
}

TEST(ChannelTest, InKernelModeWhatIsDueAtOnceTakesNoPlaceFromTheNextOfThatInstant) {
  // Linux looks at its queue after each arrival, so what waits for nothing is gone by the next.
  Channel channel{*parse_impairment("mode netem-6.1 limit 9"), 1, Direction::Up, 999};
  for (std::uint64_t i = 0; i < 500; ++i) channel.push(numbered(i), at_ms(0));
  EXPECT_EQ(channel.counters().over_limit, 0U);
  // What is delayed by no more than the time that passed is still there for the first of an
  // instant, as the timer rings after it, and for nobody else.
  Channel delayed{*parse_impairment("mode netem-6.1 delay 1ms limit 1"), 1, Direction::Up, 999};
  for (int i = 0; i < 3; ++i) delayed.push(numbered(0), at_ms(i));
  EXPECT_EQ(delayed.counters().over_limit, 1U);
}

TEST(ChannelTest, WhatIsDueTogetherLeavesAsItCame) {
  // The floor makes half of the delays equal.
  Channel channel{
      impaired("delay 10ms 5ms distribution normal floor 100% order free"), 1, Direction::Up, 999};
  Buffer buffer{};
  for (std::uint64_t i = 0; i < 500; ++i) channel.push(numbered(i), at_ms(0));
  std::uint64_t last = 0;
  int together = 0;
  while (const auto released = channel.pop(buffer, at_ms(10))) {
    EXPECT_GE(released->index, last);
    last = released->index;
    ++together;
  }
  EXPECT_GT(together, 200);
}

TEST(ChannelTest, TellsHowManyLeaveByAnInstantAndNoneOfThemTwice) {
  Channel channel{impaired("delay 10ms"), 1, Direction::Up, 99};
  for (std::uint64_t i = 0; i < 5; ++i) channel.push(numbered(i), at_ms(0));
  for (std::uint64_t i = 5; i < 8; ++i) channel.push(numbered(i), at_ms(3));
  const auto leaving_by = [&channel](TimePoint at, std::size_t most = 64) {
    return channel.impaired_path().in_line_by(at, most);
  };
  EXPECT_EQ(leaving_by(at_ms(10) - Duration{1}), 0U);
  EXPECT_EQ(leaving_by(at_ms(10)), 5U);
  EXPECT_EQ(leaving_by(at_ms(10), 3), 3U);
  EXPECT_EQ(leaving_by(at_ms(13)), 8U);
  Buffer buffer{};
  ASSERT_TRUE(channel.pop(buffer, at_ms(10)));
  EXPECT_EQ(leaving_by(at_ms(13)), 7U);
}

TEST(ChannelTest, DropsWhatNobodyCollectsAndStaysWhole) {
  Channel channel{impaired("none"), 1, Direction::Up, 1};
  for (std::uint64_t i = 0; i < 10'000; ++i) channel.push(numbered(i), at_ms(0));
  EXPECT_GT(channel.counters().over_limit, 0U);
  EXPECT_EQ(accounted(channel), 10'000U);
  Buffer buffer{};
  std::uint64_t expected = 0;
  while (const auto released = channel.pop(buffer, at_ms(0)))
    EXPECT_EQ(released->index, expected++);
  EXPECT_EQ(channel.in_flight(), 0U);
}

TEST(ChannelTest, PassesWithoutDelayInTheSameTick) {
  Channel channel{impaired("none"), 1, Direction::Up, 16};
  Buffer buffer{};
  EXPECT_FALSE(channel.next_release());
  channel.push(numbered(0), at_ms(5));
  EXPECT_EQ(channel.next_release(), at_ms(5));
  EXPECT_FALSE(channel.pop(buffer, at_ms(4)));
  EXPECT_TRUE(channel.pop(buffer, at_ms(5)));
  EXPECT_FALSE(channel.pop(buffer, at_ms(5)));
}

TEST(ChannelTest, ReleasesAtTheInstantAndNotBefore) {
  Channel channel{impaired("delay 50ms"), 1, Direction::Up, 16};
  Buffer buffer{};
  channel.push(numbered(0), at_ms(5));
  EXPECT_EQ(channel.next_release(), at_ms(55));
  EXPECT_FALSE(channel.pop(buffer, at_ms(55) - Duration{1}));
  const auto released = channel.pop(buffer, at_ms(60));
  ASSERT_TRUE(released);
  EXPECT_EQ(released->arrived_at, at_ms(5));
  EXPECT_EQ(released->released_at, at_ms(55));
}

TEST(ChannelTest, AnArrivalBeforeTheNewestCountsAsThat) {
  Channel channel{impaired("delay 50ms order free"), 1, Direction::Up, 16};
  Buffer buffer{};
  channel.push(numbered(0), at_ms(5));
  channel.push(numbered(1), at_ms(3));
  EXPECT_TRUE(channel.pop(buffer, at_ms(55)));
  const auto released = channel.pop(buffer, at_ms(55));
  ASSERT_TRUE(released);
  EXPECT_EQ(released->arrived_at, at_ms(5));
}

TEST(ChannelTest, KeepsOrderWhenToldAndCountsOvertakingWhenNot) {
  const Log kept = run(impaired("delay 30ms 10ms duplicate 5% order keep"), milliseconds{1});
  EXPECT_EQ(kept.counters.reordered, 0U);
  EXPECT_TRUE(std::is_sorted(kept.leaving.begin(), kept.leaving.end(), [](auto& left, auto& right) {
    return left.index < right.index;
  }));
  const Log freed = run(impaired("delay 30ms 10ms order free"), milliseconds{1});
  std::uint64_t overtaken = 0;
  std::uint64_t highest = 0;
  for (const Leaving& leaving : freed.leaving) {
    if (leaving.index < highest) ++overtaken;
    highest = std::max(highest, leaving.index);
  }
  EXPECT_GT(overtaken, 1000U);
  EXPECT_EQ(freed.counters.reordered, overtaken);
}

TEST(ChannelTest, BlackoutTimesBeginAtTheStart) {
  Channel channel{impaired("blackout 10ms 5ms"), 1, Direction::Up, 64, at_ms(1000)};
  for (int i = 0; i < 20; ++i) channel.push(numbered(0), at_ms(1000 + i));
  EXPECT_EQ(channel.counters().blackout, 5U);
}

TEST(ChannelTest, TakesDatagramsOfEverySizeUpToTheLargest) {
  Channel channel{impaired("none"), 1, Direction::Up, 16};
  Buffer buffer{};
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1200}}) {
    channel.push(std::vector<std::byte>(size, std::byte{7}), at_ms(0));
    const auto released = channel.pop(buffer, at_ms(0));
    ASSERT_TRUE(released);
    EXPECT_EQ(released->size, size);
  }
  channel.push(std::vector<std::byte>(1201), at_ms(0));
  EXPECT_FALSE(channel.pop(buffer, at_ms(0)));
  EXPECT_EQ(channel.counters().over_limit, 1U);
}

TEST(ChannelTest, CutsOffAtASmallBufferAndTellsTheTrueSize) {
  Channel channel{impaired("none"), 1, Direction::Up, 16};
  channel.push(std::vector<std::byte>(100, std::byte{7}), at_ms(0));
  std::array<std::byte, 11> buffer{};
  const auto released = channel.pop(std::span{buffer}.first(10), at_ms(0));
  ASSERT_TRUE(released);
  EXPECT_EQ(released->size, 100U);
  EXPECT_EQ(buffer[9], std::byte{7});
  EXPECT_EQ(buffer[10], std::byte{0});
}

TEST(ChannelTest, TellsIntendedFromAchievedDelay) {
  // Kept order turns independent jitter into its running maximum: the achieved mean is higher.
  Channel channel{impaired("delay 50ms 10ms"), 1, Direction::Up, 4096};
  Buffer buffer{};
  for (int i = 0; i < 3000; ++i) channel.push(numbered(0), at_ms(i));
  while (channel.pop(buffer, at_ms(10'000))) {
  }
  EXPECT_EQ(channel.intended_delay().count(), 3000U);
  EXPECT_EQ(channel.achieved_delay().count(), 3000U);
  EXPECT_NEAR(seconds(channel.intended_delay().mean()), 0.050, 0.0005);
  EXPECT_GT(channel.achieved_delay().mean(), milliseconds{55});
  EXPECT_LE(channel.achieved_delay().max(), milliseconds{60});
}

}  // namespace
}  // namespace palp::netem
