#pragma once

#include <array>
#include <cstdint>

#include "common/core/random.h"
#include "common/core/time.h"
#include "netem/model/impairment.h"

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
  /// A law nearby, on a ramp: the present run goes on, and ends as the new law has it.
  void lean(const Chance& law) noexcept {
    if (law != law_) rescale(law);
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
  void rescale(const Chance& law) noexcept;
  void take_law(const Chance& law) noexcept;
  void turn() noexcept;

  RandomStream stream_;
  std::uint64_t number_{};  ///< of the next draw
  Chance law_;
  double hits_{};         ///< [1], run_scale() of a run of hits
  double misses_{};       ///< [1]
  bool hit_{};            ///< of the present run
  std::uint64_t left_{};  ///< of it, at least 1
};

/// The 4-state chain of tc, one step for each datagram; drawn run by run as well.
class FourStateProcess {
 public:
  FourStateProcess(const FourStateLaw& law, RandomStream stream) noexcept : stream_{stream} {
    begin(law);
  }
  /// Another law goes on from the present state.
  void change(const FourStateLaw& law) noexcept {
    if (law != law_) begin(law);
  }

  /// Whether the next datagram is lost.
  [[nodiscard]] bool next() noexcept {
    const bool lost = state_ >= 3;
    skip(1);
    return lost;
  }
  /// As of ChanceProcess.
  [[nodiscard]] std::uint64_t quiet() const noexcept { return state_ >= 3 ? 0 : left_; }
  void skip(std::uint64_t count) noexcept {
    left_ -= count;
    if (left_ == 0) turn();
  }

 private:
  void begin(const FourStateLaw& law) noexcept;
  [[nodiscard]] std::uint64_t more() noexcept;
  void turn() noexcept;

  RandomStream stream_;
  std::uint64_t number_{};  ///< of the next draw
  FourStateLaw law_;
  std::array<double, 5> scales_{};  ///< [1], run_scale() of each state
  std::uint8_t state_{1};           ///< of the present run
  std::uint64_t left_{};            ///< of it, at least 1
};

/// Gilbert-Elliott, one step for each datagram; the loss is that of the state before the step.
/// Drawn run by run as well.
class GemodelProcess {
 public:
  GemodelProcess(const GemodelLaw& law, RandomStream steps) noexcept : steps_{steps} { begin(law); }
  /// Another law goes on from the present state.
  void change(const GemodelLaw& law) noexcept {
    if (law != law_) begin(law);
  }

  /// The probability of loss of the next datagram.
  [[nodiscard]] double next() noexcept {
    const double loss = present_loss();
    skip(1);
    return loss;
  }
  /// As of ChanceProcess.
  [[nodiscard]] std::uint64_t quiet() const noexcept { return present_loss() > 0 ? 0 : left_; }
  void skip(std::uint64_t count) noexcept {
    left_ -= count;
    if (left_ == 0) turn(!bad_);
  }

 private:
  [[nodiscard]] double present_loss() const noexcept {
    return bad_ ? law_.loss_bad : law_.loss_good;
  }
  void begin(const GemodelLaw& law) noexcept;
  void turn(bool bad) noexcept;

  RandomStream steps_;
  std::uint64_t number_{};  ///< of the next draw
  GemodelLaw law_;
  double goods_{};        ///< [1], run_scale() of a run of good
  double bads_{};         ///< [1]
  bool bad_{};            ///< of the present run
  std::uint64_t left_{};  ///< of it, at least 1
};

/// Bursts of fixed length. The times of quiet between them are exponential; who comes next after
/// one is over begins the burst.
class BurstProcess {
 public:
  explicit BurstProcess(RandomStream gaps) noexcept : gaps_{gaps} {}
  /// From `at` on another law; a burst that is on goes on.
  void change(const BurstLaw& law, TimePoint at) noexcept;
  [[nodiscard]] bool on() const noexcept { return law_.length > Duration{}; }
  [[nodiscard]] bool next(TimePoint at) noexcept;
  /// Till then next() would say no and stay as it is.
  [[nodiscard]] TimePoint harmless_until() const noexcept { return from_; }

 private:
  void plan(TimePoint from) noexcept;

  RandomStream gaps_;
  std::uint64_t number_{};
  BurstLaw law_;
  bool begun_{};
  TimePoint from_{
      TimePoint::min()};  ///< of the present burst, or who comes from then on begins one
  TimePoint until_{TimePoint::min()};  ///< end of the present or the last one
};

/// Gilbert-Elliott in time.
class GilbertTimeProcess {
 public:
  GilbertTimeProcess(RandomStream states, RandomStream lengths) noexcept
      : states_{states}, lengths_{lengths} {}
  /// From `at` on another law, in the present state: exponential stays have no memory.
  void change(const GilbertLaw& law, TimePoint at) noexcept;
  [[nodiscard]] bool on() const noexcept { return law_.bad > Duration{}; }
  /// The probability of loss at `at`.
  [[nodiscard]] double next(TimePoint at) noexcept;
  /// Till then next() would say 0 and stay as it is.
  [[nodiscard]] TimePoint harmless_until() const noexcept {
    return bad_ || law_.loss_good > 0 ? TimePoint::min() : until_;
  }

 private:
  void enter(TimePoint from) noexcept;
  [[nodiscard]] Duration stay() noexcept;

  RandomStream states_;
  RandomStream lengths_;
  GilbertLaw law_;
  std::uint64_t stay_{};  ///< index of the present stay
  bool begun_{};
  bool bad_{};
  TimePoint until_{};
};

/// Stalls: exponential times of quiet between log-normal lengths.
class StallProcess {
 public:
  StallProcess(RandomStream gaps, RandomStream lengths) noexcept : gaps_{gaps}, lengths_{lengths} {}
  /// From `at` on another law; a stall that is on goes on.
  void change(const StallLaw& law, TimePoint at) noexcept;
  [[nodiscard]] bool on() const noexcept { return law_.median > Duration{} && law_.rate > 0; }
  /// When what arrives at `at` may go on: `at`, or the end of the stall.
  [[nodiscard]] TimePoint next(TimePoint at) noexcept;
  /// Of the stall that is planned; till then next() has nothing to say.
  [[nodiscard]] TimePoint begins() const noexcept { return from_; }

 private:
  void plan(TimePoint from) noexcept;

  RandomStream gaps_;
  RandomStream lengths_;
  StallLaw law_;
  std::uint64_t number_{};
  bool begun_{};
  TimePoint from_{};
  TimePoint until_{};
};

}  // namespace palp::netem
