#include "common/io/realtime/realtime.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

// Bits of capabilities(7).
constexpr unsigned kCapIpcLock = 14;
constexpr unsigned kCapSysNice = 23;

std::uint64_t effective_capabilities() {
  std::ifstream status{"/proc/self/status"};
  for (std::string word; status >> word;) {
    if (word == "CapEff:") {
      std::uint64_t bits = 0;
      status >> std::hex >> bits;
      return bits;
    }
  }
  return 0;
}

bool has(std::uint64_t capabilities, unsigned bit) { return ((capabilities >> bit) & 1U) != 0; }

/// Deeper than any tick of ours goes.
constexpr std::size_t kStackTouched = 256UL * 1024;  ///< [bytes]

__attribute__((noinline)) void touch_stack() noexcept {
  constexpr std::size_t kPage = 4096;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): touched page by page below
  std::array<volatile char, kStackTouched> stack;
  for (std::size_t at = 0; at < kStackTouched; at += kPage) {
    stack[at] = 0;
  }
}

void request_priority(int priority, const RealtimeLimits& limits, RealtimeGrant& grant) {
  if (priority <= 0) {
    grant.scheduling = "ordinary scheduling, as asked";
    return;
  }
  const std::string wish = "SCHED_FIFO " + std::to_string(priority);
  const int possible = std::min(priority, limits.priority_max);
  if (possible <= 0) {
    grant.scheduling = wish + " not granted: RLIMIT_RTPRIO is 0 and CAP_SYS_NICE is missing";
    return;
  }
  sched_param parameter{};
  parameter.sched_priority = possible;
  const int refusal = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  if (refusal != 0) {
    grant.scheduling = wish + " not granted: " + system_text(refusal);
    return;
  }
  grant.priority = possible;
  grant.scheduling = "SCHED_FIFO " + std::to_string(possible);
  if (possible < priority) {
    grant.scheduling +=
        " instead of " + std::to_string(priority) + ": RLIMIT_RTPRIO allows no more";
  }
}

void request_memory_lock(const RealtimeLimits& limits, RealtimeGrant& grant) {
  if (!limits.memory_unlimited) {
    grant.memory = "memory not locked: the limit (ulimit -l) is " + limits.memory_limit +
                   " and CAP_IPC_LOCK is missing; it must be unlimited";
    return;
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    grant.memory = "memory not locked: " + system_text(errno);
    return;
  }
  // A capability of a user namespace does not count in the kernel's check: ask for more address
  // space than the limit before anything depends on it. PROT_NONE: no page is ever used.
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const std::size_t more = static_cast<std::size_t>(limit.rlim_cur) + 4096;
    void* probe = mmap(nullptr, more, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (probe == MAP_FAILED) {
      munlockall();
      grant.memory = "memory not locked: the limit (ulimit -l) of " + limits.memory_limit +
                     " holds here in spite of CAP_IPC_LOCK";
      return;
    }
    munmap(probe, more);
  }
  grant.memory_locked = true;
  grant.memory = "memory locked";
}

}  // namespace

RealtimeLimits read_realtime_limits() {
  const std::uint64_t capabilities = effective_capabilities();
  RealtimeLimits limits;
  rlimit limit{};
  if (has(capabilities, kCapSysNice)) {
    limits.priority_max = 99;
  } else if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) {
    limits.priority_max = static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 99));
  }
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0) {
    const bool infinite = limit.rlim_cur == RLIM_INFINITY;
    limits.memory_unlimited = infinite || has(capabilities, kCapIpcLock);
    limits.memory_limit = infinite ? "unlimited" : std::to_string(limit.rlim_cur / 1024) + " KiB";
  }
  return limits;
}

RealtimeGrant request_realtime(int priority, bool lock_memory, const RealtimeLimits& limits) {
  RealtimeGrant grant;
  request_priority(priority, limits, grant);
  if (lock_memory) {
    request_memory_lock(limits, grant);
  } else {
    grant.memory = "memory not locked, as asked";
  }
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // [ns]; best effort, FIFO threads have none
  touch_stack();
  return grant;
}

void name_this_thread(const std::string& name) noexcept {
  constexpr std::size_t kLength = 15;  // pthread_setname_np(3)
  std::array<char, kLength + 1> shortened{};
  name.copy(shortened.data(), kLength);
  pthread_setname_np(pthread_self(), shortened.data());
}

}  // namespace palp::io
