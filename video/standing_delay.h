#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/core/time.h"

namespace palp::video {

/// How long the force telegrams stand in a queue on their way: they are a probe of 1 kHz that
/// exists anyway, and video yields to it. The least one-way delay of 100 ms, less the 5 % quantile
/// of these minima over 10 s, less 1.5 times their mean difference over 100 ms: so the link's own
/// jitter takes itself out. The clocks' offset, which is in all of them, does too.
/// A value. Thread: one.
class StandingDelay {
 public:
  static constexpr Duration kStep = std::chrono::microseconds{33'333};

  struct Reading {
    Duration standing{};       ///< never below 0
    std::uint64_t expected{};  ///< telegrams of the last 2 s, by their numbers
    std::uint64_t arrived{};   ///< of those
  };

  /// A telegram of the peer. `one_way`: arrival, on our clock, less sending, on the peer's.
  void add(std::uint64_t number, Duration one_way, TimePoint arrived_at) noexcept;
  /// As of `now`, which does not fall.
  [[nodiscard]] Reading read(TimePoint now);

 private:
  static constexpr std::size_t kMinima = 300;  ///< 10 s
  static constexpr std::size_t kCounts = 60;   ///< 2 s

  void step();
  [[nodiscard]] Duration standing() const;

  struct Count {
    std::uint64_t expected{};
    std::uint64_t arrived{};
  };
  TimePoint step_ends_at_{};
  bool begun_{};
  std::array<Duration, 3> least_{Duration::max(), Duration::max(), Duration::max()};  ///< of steps
  std::deque<Duration> minima_;  ///< of 100 ms, one a step
  std::deque<Count> counts_;
  Count count_;  ///< so far
  std::uint64_t newest_{};
};

}  // namespace palp::video
