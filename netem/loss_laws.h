#pragma once

#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/impairment.h"

/// The losses of mode exact, each a small state machine that draws from streams of its own by the
/// number of the datagram (or of the stay), so that none disturbs another.
/// Thread: their owner's, fit for rt.
namespace palp::netem {

/// Two-state Markov chain: P(hit) = share in the long run, and lag-1 correlation as asked:
/// P(hit | hit) = P + C (1 - P), P(hit | no hit) = P (1 - C). Drawn run by run: the length of a run
/// is geometric, so most datagrams need no draw.
class ChanceProcess {
 public:
  ChanceProcess(const Chance& law, RandomStream stream) noexcept : stream_{stream} { begin(law); }

  /// The same law goes on as if nothing had been said.
  void change(const Chance& law) noexcept {
    if (law != law_) begin(law);
  }

  /// Of the next datagram.
  [[nodiscard]] bool next() noexcept {
    const bool hit = hit_;
    skip(1);
    return hit;
  }
  /// So many will not be hit, it is known without a draw ...
  [[nodiscard]] std::uint64_t quiet() const noexcept { return hit_ ? 0 : left_; }
  /// ... and need not be asked for: `count` of them have passed.
  void skip(std::uint64_t count) noexcept {
    left_ -= count;
    if (left_ == 0) turn();
  }
  /// Of a copy: a sibling of its original that leaves no trace.
  [[nodiscard]] bool aside(RandomStream stream, std::uint64_t index) const noexcept {
    return stream.uniform(index) < law_.share;
  }

 private:
  void begin(const Chance& law) noexcept;
  void turn() noexcept;

  RandomStream stream_;
  std::uint64_t number_{};  ///< of the next draw
  Chance law_;
  double hits_{};         ///< [1], run_scale() of a run of hits
  double misses_{};       ///< [1]
  bool hit_{};            ///< of the present run
  std::uint64_t left_{};  ///< of it, at least 1
};

/// The 4-state chain of tc, one step for each datagram.
class FourStateProcess {
 public:
  explicit FourStateProcess(RandomStream stream) noexcept : stream_{stream} {}
  [[nodiscard]] bool next(const FourStateLaw& law, std::uint64_t index) noexcept;

 private:
  RandomStream stream_;
  std::uint8_t state_{1};
};

/// Gilbert-Elliott, one step for each datagram; the loss is that of the state before the step.
class GemodelProcess {
 public:
  explicit GemodelProcess(RandomStream steps) noexcept : steps_{steps} {}
  /// The probability of loss of datagram `index`.
  [[nodiscard]] double next(const GemodelLaw& law, std::uint64_t index) noexcept {
    const bool was_bad = bad_;
    if (steps_.uniform(index) < (bad_ ? law.to_good : law.to_bad)) bad_ = !bad_;
    return was_bad ? law.loss_bad : law.loss_good;
  }

 private:
  RandomStream steps_;
  bool bad_{};
};

/// Bursts of fixed length that begin at random times.
class BurstProcess {
 public:
  explicit BurstProcess(RandomStream stream) noexcept : stream_{stream} {}
  [[nodiscard]] bool next(const BurstLaw& law, TimePoint at, std::uint64_t index) noexcept;

 private:
  RandomStream stream_;
  TimePoint last_at_{};
  TimePoint until_{};
  bool first_{true};
  bool seen_{};
};

/// Gilbert-Elliott in time.
class GilbertTimeProcess {
 public:
  GilbertTimeProcess(RandomStream states, RandomStream lengths) noexcept
      : states_{states}, lengths_{lengths} {}
  /// The probability of loss at `at`.
  [[nodiscard]] double next(const GilbertLaw& law, TimePoint at) noexcept;
  /// Till then next() would say 0 and stay as it is.
  [[nodiscard]] TimePoint harmless_until(const GilbertLaw& law) const noexcept {
    return bad_ || law.loss_good > 0 ? TimePoint::min() : until_;
  }

 private:
  void enter(const GilbertLaw& law, TimePoint from) noexcept;

  RandomStream states_;
  RandomStream lengths_;
  std::uint64_t stay_{};  ///< index of the present stay
  bool begun_{};
  bool bad_{};
  TimePoint until_{};
};

/// Stalls: exponential times of quiet between log-normal lengths.
class StallProcess {
 public:
  StallProcess(RandomStream gaps, RandomStream lengths) noexcept : gaps_{gaps}, lengths_{lengths} {}
  /// When what arrives at `at` may go on: `at`, or the end of the stall.
  [[nodiscard]] TimePoint next(const StallLaw& law, TimePoint at) noexcept;
  /// Of the stall that is planned; till then next() has nothing to say.
  [[nodiscard]] TimePoint begins() const noexcept { return from_; }

 private:
  void plan(const StallLaw& law, TimePoint from) noexcept;

  RandomStream gaps_;
  RandomStream lengths_;
  std::uint64_t number_{};
  bool begun_{};
  TimePoint from_{};
  TimePoint until_{};
};

}  // namespace palp::netem
