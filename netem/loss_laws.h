#pragma once

#include <cstdint>
#include <limits>

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
    share_ = most_bits(law.share);
    after_hit_ = most_bits(law.share + law.correlation * (1 - law.share));
    after_miss_ = most_bits(law.share * (1 - law.correlation));
    never_after_miss_ = law.share * (1 - law.correlation) <= 0;
    now_ = share_;
    begun_ = false;
    correlated_ = law.correlation > 0;
  }
  [[nodiscard]] bool off() const noexcept { return off_; }

  /// Of datagram `index`; to be asked once for each.
  [[nodiscard]] bool next(std::uint64_t index) noexcept {
    if (off_) return false;
    const bool hit = stream_.bits(index) <= now_ && !(begun_ && never_after_miss_ && !hit_);
    if (correlated_) {
      now_ = hit ? after_hit_ : after_miss_;
      begun_ = true;
      hit_ = hit;
    }
    return hit;
  }
  /// Of a copy: a sibling of its original that leaves no trace.
  [[nodiscard]] bool aside(RandomStream stream, std::uint64_t index) const noexcept {
    return !off_ && stream.bits(index) <= share_;
  }

 private:
  /// The most that 64 random bits may be to hit with that probability, which is above 0.
  [[nodiscard]] static std::uint64_t most_bits(double share) noexcept {
    if (share >= 1) return std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(share * 0x1.0p64);
  }

  RandomStream stream_;
  std::uint64_t share_{};
  std::uint64_t after_hit_{};
  std::uint64_t after_miss_{};
  std::uint64_t now_{};  ///< what holds for the next one
  bool off_{};
  bool correlated_{};
  bool never_after_miss_{};  ///< a correlation of 1
  bool begun_{};
  bool hit_{};
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
