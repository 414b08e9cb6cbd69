#pragma once

#include <algorithm>
#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/impairment.h"

/// The losses of mode exact, each a small state machine that draws from streams of its own by the
/// number of the datagram (or of the stay), so that none disturbs another.
/// Thread: their owner's, fit for rt.
namespace palp::netem {

/// Two-state Markov chain: P(hit) = share in the long run, and lag-1 correlation as asked:
/// P(hit | hit) = P + C (1 - P), P(hit | no hit) = P (1 - C).
class ChanceProcess {
 public:
  ChanceProcess(const Chance& law, RandomStream stream) noexcept : stream_{stream} { change(law); }

  void change(const Chance& law) noexcept {
    off_ = law.share <= 0;
    share_ = threshold(law.share);
    after_hit_ = threshold(law.share + law.correlation * (1 - law.share));
    after_miss_ = threshold(law.share * (1 - law.correlation));
    now_ = share_;
  }
  [[nodiscard]] bool off() const noexcept { return off_; }

  /// Of datagram `index`; to be asked once for each.
  [[nodiscard]] bool next(std::uint64_t index) noexcept {
    if (off_) return false;
    const bool hit = (stream_.bits(index) >> 1U) < now_;
    now_ = hit ? after_hit_ : after_miss_;
    return hit;
  }
  /// Of a copy: a sibling of its original that leaves no trace.
  [[nodiscard]] bool aside(RandomStream stream, std::uint64_t index) const noexcept {
    return (stream.bits(index) >> 1U) < share_;
  }

 private:
  /// What 63 random bits must lie below to hit with that probability; exact for 0 and 1.
  [[nodiscard]] static std::uint64_t threshold(double share) noexcept {
    return static_cast<std::uint64_t>(std::clamp(share, 0.0, 1.0) * 0x1.0p63);
  }

  RandomStream stream_;
  std::uint64_t share_{};
  std::uint64_t after_hit_{};
  std::uint64_t after_miss_{};
  std::uint64_t now_{};  ///< what holds for the next one
  bool off_{};
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
