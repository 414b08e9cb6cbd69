#include "common/io/realtime/periodic_loop.h"

#include "common/core/check.h"
#include "common/core/denormals.h"
#include "common/io/realtime/steady_clock.h"

namespace palp::io {
namespace {

/// A warm-up takes 10 us where it is needed most, with all caches cold; with less time than this
/// before the deadline it is left out. Waking comes so much earlier for it that the kernel may be
/// late by 85 us, which it is at most once in a hundred periods on an ordinary machine.
constexpr Duration kWarmUpTime = std::chrono::microseconds{15};
constexpr Duration kWakeEarlier = std::chrono::microseconds{50};

/// Sleeps until `spin` before the deadline, warms up, and spins the rest. @returns the time then.
TimePoint wait_for(const SteadyClock& clock,
                   TimePoint deadline,
                   Duration spin,
                   const std::function<void()>& warm_up) {
  TimePoint now = clock.now();
  const Duration awake = warm_up ? spin + kWakeEarlier : spin;
  if (deadline - now > awake) {
    clock.sleep_until(deadline - awake);
    now = clock.now();
  }
  if (warm_up && deadline - now >= kWarmUpTime) {
    warm_up();
    now = clock.now();
  }
  while (now < deadline) {
    now = clock.now();
  }
  return now;
}

LoopStats account(const DeadlineSchedule& schedule, RealtimeGrant grant) {
  const LoopProgress& progress = schedule.progress();
  const Histogram& lateness = schedule.lateness();
  return {.ticks = progress.ticks,
          .missed = progress.missed,
          .overruns = progress.overruns,
          .lateness_max = progress.lateness_max,
          .lateness_p50 = lateness.quantile(0.5),
          .lateness_p99 = lateness.quantile(0.99),
          .lateness_p999 = lateness.quantile(0.999),
          .grant = std::move(grant)};
}

}  // namespace

LoopStats run_periodic(const LoopConfig& config,
                       const std::function<void(TimePoint now)>& tick,
                       const std::stop_token& stop,
                       const LoopTaps& taps) {
  PALP_CHECK(config.period > Duration{0}, "a loop's period is positive");
  PALP_CHECK(config.spin < config.period, "a loop sleeps in each period");
  RealtimeGrant grant =
      request_realtime(config.priority, config.lock_memory, read_realtime_limits());
  if (taps.granted) {
    taps.granted(grant);
  }
  const DenormalFlush flush;
  const SteadyClock clock;
  DeadlineSchedule schedule{clock.now() + config.period, config.period};
  while (!stop.stop_requested()) {
    const TimePoint now = wait_for(clock, schedule.deadline(), config.spin, taps.warm_up);
    schedule.begin(now);
    tick(now);
    schedule.end(clock.now());
    if (taps.progress != nullptr) {
      taps.progress->put(schedule.progress());
    }
  }
  return account(schedule, std::move(grant));
}

}  // namespace palp::io
