#include "common/io/realtime/wall_clock.h"

#include <sys/timex.h>
#include <time.h>

#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

Duration since_1970() noexcept {
  timespec stamp{};
  clock_gettime(CLOCK_REALTIME, &stamp);
  return std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec};
}

Duration local_zone(Duration since) noexcept {
  const std::time_t now = std::chrono::duration_cast<std::chrono::seconds>(since).count();
  tm local{};
  if (localtime_r(&now, &local) == nullptr) return {};
  return std::chrono::seconds{local.tm_gmtoff};
}

}  // namespace

WallClockReading read_wall_clock() noexcept {
  constexpr int kTries = 8;
  const SteadyClock steady;
  WallClockReading reading;
  Duration tightest = Duration::max();
  for (int i = 0; i < kTries; ++i) {
    const TimePoint before = steady.now();
    const Duration wall = since_1970();
    const TimePoint after = steady.now();
    if (after - before >= tightest) continue;
    tightest = after - before;
    reading.ahead = wall - (before + tightest / 2).time_since_epoch();
    reading.zone = local_zone(wall);
  }
  timex state{};
  const int answer = adjtimex(&state);
  reading.synchronised = answer >= 0 && answer != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  if (reading.synchronised) reading.uncertainty = std::chrono::microseconds{state.maxerror};
  return reading;
}

}  // namespace palp::io
