#include "common/link/clock_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"

namespace palp::link {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

/// A peer whose clock is `offset` ahead at 0 and gains `skew`.
struct Peer {
  Duration offset{};
  double skew{};  ///< [s/s]

  [[nodiscard]] Duration clock(TimePoint now) const {
    return offset + now.time_since_epoch() + from_seconds(skew * seconds(now.time_since_epoch()));
  }
  [[nodiscard]] Duration ahead(TimePoint now) const { return clock(now) - now.time_since_epoch(); }

  /// An exchange that began at `now`: `there`, 300 us at the peer, `here`.
  void exchange(ClockOffsetEstimator& estimator, TimePoint now, Duration there, Duration here) {
    const TimePoint met = now + there;
    const TimePoint sent = met + 300us;
    const TimePoint back = sent + here;
    estimator.add_there(clock(met) - now.time_since_epoch(), clock(sent), back);
    estimator.add_here(back.time_since_epoch() - clock(sent), back, back);
  }
};

TEST(ClockOffsetTest, SaysNothingBeforeTheFirstWholeSecond) {
  ClockOffsetEstimator estimator;
  Peer peer{5s, 0};
  for (auto at = 0ms; at < 990ms; at += 10ms) peer.exchange(estimator, TimePoint{at}, 1ms, 1ms);
  EXPECT_FALSE(estimator.estimate());
  EXPECT_EQ(estimator.delay_in(), Duration{});
  peer.exchange(estimator, TimePoint{1s}, 1ms, 1ms);
  EXPECT_TRUE(estimator.estimate());
}

RC_GTEST_PROP(ClockOffsetTest, IsExactOverEqualConstantWays, ()) {
  Peer peer{std::chrono::milliseconds{*rc::gen::inRange(-100'000'000, 100'000'000)},
            *rc::gen::inRange(-50, 50) * 1e-6};
  const Duration way = std::chrono::microseconds{*rc::gen::inRange(0, 500'000)};
  const TimePoint begin{std::chrono::milliseconds{*rc::gen::inRange(-50'000, 50'000)}};
  const Duration length = std::chrono::seconds{*rc::gen::inRange(3, 40)};
  ClockOffsetEstimator estimator;
  for (Duration since{}; since < length; since += 10ms) {
    peer.exchange(estimator, begin + since, way, way);
  }
  RC_ASSERT(estimator.estimate().has_value());
  const TimePoint now = begin + length;
  // The prior of the skew pulls a little while few seconds are there; and a way is measured on one
  // clock in one direction and on the other in the other.
  const double drift = std::abs(peer.skew) * seconds(way);
  const double error = seconds(estimator.estimate()->offset_at(now) - peer.ahead(now));
  RC_ASSERT(std::abs(error) <= drift + (length > 8s ? 1e-6 : 20e-6));
  RC_ASSERT(std::abs(seconds(estimator.estimate()->uncertainty - way)) <= drift + 2e-6);
  RC_ASSERT(std::abs(seconds(estimator.delay_in() - way)) <= drift + (length > 8s ? 5e-6 : 25e-6));
}

TEST(ClockOffsetTest, AnUnequalWayShowsAsHalfItsDifferenceWhichIsWithinTheUncertainty) {
  Peer peer{};
  ClockOffsetEstimator estimator;
  for (auto at = 0ms; at < 20s; at += 10ms) peer.exchange(estimator, TimePoint{at}, 30ms, 10ms);
  const ClockOffset estimate = *estimator.estimate();
  EXPECT_NEAR(seconds(estimate.offset), 10e-3, 1e-6);
  EXPECT_NEAR(seconds(estimate.uncertainty), 20e-3, 2e-6);
  EXPECT_LE(std::chrono::abs(estimate.offset), estimate.uncertainty);
}

/// Absolute errors [s] after 20 s over `seeds` links whose queues are Pareto's (shape 2, mean
/// excess `queue`), 100 exchanges a second, 20 ppm. `step`: so much longer both ways are in every
/// second 15 s.
std::vector<double> errors_over_queues(Duration way,
                                       Duration queue,
                                       std::uint64_t seeds,
                                       Duration step = {}) {
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Peer peer{1234567us, 20e-6};
    ClockOffsetEstimator estimator;
    for (std::uint64_t k = 0; k < 3000; ++k) {
      const auto queued = [&](std::uint64_t stream) {
        const double u = random_middle(random_bits(seed, stream, k));
        const Duration level = k / 1500 % 2 == 1 ? way + step : way;
        return level + from_seconds(seconds(queue) * (1 / std::sqrt(u) - 1));
      };
      const TimePoint now{10ms * static_cast<std::int64_t>(k)};
      peer.exchange(estimator, now, queued(1), queued(2));
      if (k > 2000 && k % 50 == 0) {
        errors.push_back(std::abs(seconds(estimator.estimate()->offset_at(now) - peer.ahead(now))));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(ClockOffsetTest, QueuesWithAFloorLeaveMicroseconds) {
  for (const auto& errors : {errors_over_queues(40ms, 1ms, 20), errors_over_queues(8ms, 3ms, 20)}) {
    EXPECT_LE(errors[errors.size() / 2], 20e-6);
    EXPECT_LE(errors[errors.size() * 99 / 100], 100e-6);
  }
}

TEST(ClockOffsetTest, WhatLengthensBothWaysAlikeIsNotInTheOffset) {
  // As when another satellite takes over every 15 s.
  const auto errors = errors_over_queues(25ms, 1ms, 20, 12ms);
  EXPECT_LE(errors[errors.size() / 2], 20e-6);
  EXPECT_LE(errors[errors.size() * 99 / 100], 100e-6);
}

/// As above, with normal jitter of `spread` that remembers itself for 40 ms, and no edge.
/// The session began `age` before.
std::vector<double> errors_over_normal_jitter(Duration spread,
                                              std::uint64_t seeds,
                                              Duration age = {}) {
  constexpr Duration kStep = 4ms;
  const double memory = std::exp(-seconds(kStep) / 0.04);
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Peer peer{1234567us, 20e-6};
    ClockOffsetEstimator estimator;
    peer.exchange(estimator, TimePoint{-age}, 40ms, 40ms);
    std::array<double, 2> state{};
    for (std::uint64_t k = 0; k < 7500; ++k) {
      for (std::uint64_t way = 0; way < 2; ++way) {
        state[way] =
            memory * state[way] + std::sqrt(1 - memory * memory) * random_normal(seed, 10 + way, k);
      }
      const TimePoint now{kStep * static_cast<std::int64_t>(k)};
      peer.exchange(estimator,
                    now,
                    40ms + from_seconds(seconds(spread) * state[0]),
                    40ms + from_seconds(seconds(spread) * state[1]));
      if (k > 5000 && k % 100 == 0) {
        errors.push_back(std::abs(seconds(estimator.estimate()->offset_at(now) - peer.ahead(now))));
      }
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(ClockOffsetTest, JitterWithoutAnEdgeLeavesLittleMoreThanTheCramerRaoBound) {
  for (const auto& [spread, age] : {std::pair{300us, 0s}, {1000us, 0s}, {300us, 7200s}}) {
    const auto errors = errors_over_normal_jitter(spread, 40, age);
    // Of an Ornstein-Uhlenbeck process that is seen for T the mean is known to no better than
    // sd * sqrt(2 memory / (T + 2 memory)); of two ways half the difference; at the end of a line
    // whose slope is not known, twice that. Here of 20 s, the shortest that are judged.
    const double bound = 2 * seconds(spread) * std::sqrt(0.04 / (20 + 0.08));
    EXPECT_LE(errors[errors.size() / 2], 1.3 * 0.6745 * bound);
    EXPECT_LE(errors[errors.size() * 9 / 10], 1.35 * 1.645 * bound);
  }
}

TEST(ClockOffsetTest, MiddlesThatOneDirectionsQueueLiftsAreNotBelieved) {
  Peer peer{1s, 0};
  ClockOffsetEstimator estimator;
  for (std::uint64_t k = 0; k < 2500; ++k) {
    // One in twenty goes through at once; the others wait 4 ms, there only.
    const Duration there = k % 20 == 0 ? 20ms : 24ms;
    peer.exchange(estimator, TimePoint{10ms * static_cast<std::int64_t>(k)}, there, 20ms);
  }
  EXPECT_NEAR(seconds(estimator.estimate()->offset), 1, 20e-6);
}

TEST(ClockOffsetTest, SecondsThatWereQueuedAsAWholeCountForLittle) {
  Peer peer{1s, 0};
  ClockOffsetEstimator estimator;
  for (auto at = 0ms; at < 20s; at += 10ms) {
    const bool stuck = at / 1s % 5 == 2;
    peer.exchange(estimator, TimePoint{at}, stuck ? 80ms : 20ms, 20ms);
  }
  EXPECT_NEAR(seconds(estimator.estimate()->offset), 1, 20e-6);
}

}  // namespace
}  // namespace palp::link
