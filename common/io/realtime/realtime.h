#pragma once

#include <string>

namespace palp::io {

/// What the system gave of what was asked for, and why not the rest, in sentences for people.
struct RealtimeGrant {
  int priority{};          ///< SCHED_FIFO of the thread; 0: an ordinary thread
  bool memory_locked{};    ///< of the whole process, present and future
  std::string scheduling;  ///< one sentence on the priority
  std::string memory;      ///< one sentence on the lock
};

/// The limits that decide, as read from the system (getrlimit(2), capabilities(7)).
struct RealtimeLimits {
  int priority_max{};        ///< RLIMIT_RTPRIO, or 99 with CAP_SYS_NICE
  bool memory_unlimited{};   ///< RLIMIT_MEMLOCK is unlimited, or CAP_IPC_LOCK
  std::string memory_limit;  ///< for people, as `ulimit -l` prints it
};

[[nodiscard]] RealtimeLimits read_realtime_limits();

/// Asks SCHED_FIFO `priority` (1..99, 0: none) for the calling thread, as far as the limits go, and
/// prepares it: timer slack of 1 ns, stack touched. With `lock_memory` all memory of the
/// process is locked, but only where the limit cannot run out later: under a finite one the lock
/// itself may succeed and any allocation after it fail. Never throws for lack of rights.
[[nodiscard]] RealtimeGrant request_realtime(int priority,
                                             bool lock_memory,
                                             const RealtimeLimits& limits);

/// Names the calling thread, for `top -H` and debuggers; at most 15 characters count.
void name_this_thread(const std::string& name) noexcept;

}  // namespace palp::io
