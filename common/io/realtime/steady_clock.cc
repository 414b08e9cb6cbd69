#include "common/io/realtime/steady_clock.h"

#include <cerrno>

#include <time.h>

namespace palp::io {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

}  // namespace

TimePoint SteadyClock::now() const noexcept {
  timespec stamp{};
  clock_gettime(CLOCK_MONOTONIC, &stamp);
  return TimePoint{Duration{stamp.tv_sec * kNanosecondsPerSecond + stamp.tv_nsec}};
}

void SteadyClock::sleep_until(TimePoint deadline) const noexcept {
  const std::int64_t count = deadline.time_since_epoch().count();
  if (count <= 0) {
    return;
  }
  const timespec until{.tv_sec = count / kNanosecondsPerSecond,
                       .tv_nsec = count % kNanosecondsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace palp::io
