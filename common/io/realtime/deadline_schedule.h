#pragma once

#include <algorithm>
#include <cstdint>

#include "common/core/histogram.h"
#include "common/core/time.h"

namespace palp::io {

/// What a loop looks like while it runs.
struct LoopProgress {
  std::uint64_t ticks{};
  std::uint64_t missed{};    ///< periods without a tick, whoever was to blame
  std::uint64_t overruns{};  ///< ticks that took longer than a period by themselves
  Duration lateness_max{};   ///< of a tick's beginning behind its deadline
};

/// The arithmetic of a periodic loop: absolute deadlines at whole periods from the first. Told the
/// time, never asks it. A period whose deadline passes while a tick is still at work is missed:
/// counted and skipped, never made up for in a burst. Thread: its loop's.
class DeadlineSchedule {
 public:
  /// `period` > 0.
  DeadlineSchedule(TimePoint first, Duration period) noexcept : deadline_{first}, period_{period} {}

  /// When the next tick is due.
  [[nodiscard]] TimePoint deadline() const noexcept { return deadline_; }

  /// The tick of deadline() begins.
  void begin(TimePoint now) noexcept {
    began_at_ = now;
    const Duration lateness = std::max(Duration{0}, now - deadline_);
    progress_.lateness_max = std::max(progress_.lateness_max, lateness);
    lateness_.record(lateness);
    ++progress_.ticks;
  }

  /// The tick is done: on to the first deadline that has not passed.
  void end(TimePoint now) noexcept {
    if (now - began_at_ > period_) {
      ++progress_.overruns;
    }
    deadline_ += period_;
    if (now > deadline_) {
      const std::int64_t skipped = (now - deadline_ + period_ - Duration{1}) / period_;
      progress_.missed += static_cast<std::uint64_t>(skipped);
      deadline_ += skipped * period_;
    }
  }

  [[nodiscard]] const LoopProgress& progress() const noexcept { return progress_; }
  [[nodiscard]] const Histogram& lateness() const noexcept { return lateness_; }

 private:
  TimePoint deadline_;
  Duration period_;
  TimePoint began_at_{};
  LoopProgress progress_;
  Histogram lateness_;
};

}  // namespace palp::io
