// What recording adds to a tick of a site: recording_bench [SECONDS]
// Both nodes as in site_tick_bench. Ten ticks with the site's queue of records and ten without take
// turns, so that whatever else the machine does befalls both. Microseconds of the thread's own
// time, each tick by itself. Exit code 1: the mean of a site is higher by more than 2 us.
#include <array>
#include <cstdio>
#include <cstdlib>

#include <time.h>

#include "common/core/denormals.h"
#include "tests/bench/two_sites.h"

namespace palp::bench {
namespace {

constexpr double kAddedMax = 2;  ///< [us]
constexpr int kTurn = 10;        ///< [ticks]

double now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

struct Mean {
  double sum{};  ///< [us]
  int count{};
  [[nodiscard]] double value() const { return sum / count; }
};

/// Without and with recording.
struct Costs {
  std::array<Mean, 2> surgeon;
  std::array<Mean, 2> patient;
};

Costs measure(const std::string& coupling, Duration span) {
  TimePoint now{std::chrono::seconds{1}};
  const lab::Scenario scenario = standard_scenario(coupling);
  TwoSites sites{scenario, now};
  Costs costs;
  int tick = 0;
  for (const TimePoint end = now + span; now < end; ++tick) {
    now += scenario.link.period;
    const bool on = tick / kTurn % 2 != 0;
    sites.record(on);
    const double begin = now_us();
    sites.tick_surgeon(now);
    const double between = now_us();
    sites.tick_patient(now);
    const double done = now_us();
    costs.surgeon[on ? 1 : 0].sum += between - begin;
    ++costs.surgeon[on ? 1 : 0].count;
    costs.patient[on ? 1 : 0].sum += done - between;
    ++costs.patient[on ? 1 : 0].count;
    sites.drop_records();
    sites.drop_contact();
  }
  return costs;
}

bool report(const std::string& coupling, const char* site, const std::array<Mean, 2>& costs) {
  const double added = costs[1].value() - costs[0].value();
  std::printf("%-8s %-8s without %6.2f us  with %6.2f us  added %6.2f us\n",
              coupling.c_str(),
              site,
              costs[0].value(),
              costs[1].value(),
              added);
  return added <= kAddedMax;
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const palp::DenormalFlush flush;
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 30;
  bool good = seconds > 0;
  if (!good) std::fprintf(stderr, "recording_bench: SECONDS must be a whole number above 0\n");
  for (const std::string_view name : palp::coupling::kCouplingNames) {
    if (seconds <= 0) break;
    const auto costs = palp::bench::measure(std::string{name}, std::chrono::seconds{seconds});
    good &= palp::bench::report(std::string{name}, "surgeon", costs.surgeon);
    good &= palp::bench::report(std::string{name}, "patient", costs.patient);
  }
  return good ? 0 : 1;
}
