#pragma once

#include <functional>
#include <stop_token>

#include "common/core/mailbox.h"
#include "common/core/time.h"
#include "common/io/realtime/deadline_schedule.h"
#include "common/io/realtime/realtime.h"

namespace palp::io {

struct LoopConfig {
  Duration period{std::chrono::milliseconds{1}};  ///< > 0
  /// Busy wait before a deadline: takes the median lateness to zero for 5 % of a core. A thread
  /// of SCHED_FIFO must sleep now and then, or the kernel stops it for 40 to 60 ms.
  Duration spin{std::chrono::microseconds{50}};
  int priority{};      ///< SCHED_FIFO 1..99, 0: leave as it is
  bool lock_memory{};  ///< of the whole process, where the limits permit it for good
};

/// The account of a finished loop.
struct LoopStats {
  std::uint64_t ticks{};
  std::uint64_t missed{};    ///< periods without a tick
  std::uint64_t overruns{};  ///< ticks that took longer than a period by themselves
  Duration lateness_max{};   ///< of a tick's beginning behind its deadline
  Duration lateness_p50{};
  Duration lateness_p99{};
  Duration lateness_p999{};
  RealtimeGrant grant;
};

/// Where a running loop tells how it is; both may be left out.
struct LoopTaps {
  std::function<void(const RealtimeGrant&)> granted{};  ///< once, before the first tick
  /// Once a period, awake before the deadline, where enough of the spin is left for it: some 10 us
  /// of work that makes the tick quick, its outcome of no account.
  std::function<void()> warm_up{};
  Mailbox<LoopProgress>* progress{};  ///< put after each tick; writer: the loop
};

/// Calls `tick` at absolute deadlines until stopped, with the time at which it really began. A
/// missed period is counted, not made up for, so two ticks are a whole number of periods apart
/// give or take their lateness. Denormals are flushed around all ticks. Thread: the caller's, which
/// should be one of its own: it keeps the priority. `tick` must not throw.
LoopStats run_periodic(const LoopConfig& config,
                       const std::function<void(TimePoint now)>& tick,
                       const std::stop_token& stop,
                       const LoopTaps& taps = {});

}  // namespace palp::io
