// What one tick of a site costs, for every coupling: site_tick_bench [SECONDS [filtered]]
// Both nodes with real telegrams, records and simulated devices, on a path of 20 ms with jitter and
// loss; the script palpates. Each tick is timed by itself, in microseconds. Exit code 1: the median
// of a node is above 20 us. `filtered`: under the filter of system calls that the programs have.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <time.h>

#include "common/core/denormals.h"
#include "common/io/process/system_call_filter.h"
#include "tests/bench/two_sites.h"

namespace palp::bench {
namespace {

constexpr double kMedianMax = 20;  ///< [us]

double now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

struct Costs {
  std::vector<double> surgeon;  ///< [us]
  std::vector<double> patient;  ///< [us]
};

Costs measure(const std::string& coupling, Duration span) {
  TimePoint now{std::chrono::seconds{1}};
  const lab::Scenario scenario = standard_scenario(coupling);
  TwoSites sites{scenario, now};
  Costs costs;
  for (const TimePoint end = now + span; now < end;) {
    now += scenario.link.period;
    const double begin = now_us();
    sites.tick_surgeon(now);
    const double between = now_us();
    sites.tick_patient(now);
    const double done = now_us();
    costs.surgeon.push_back(between - begin);
    costs.patient.push_back(done - between);
    sites.drop_records();
    sites.drop_contact();
  }
  return costs;
}

bool report(const std::string& coupling, const char* site, std::vector<double>& costs) {
  std::sort(costs.begin(), costs.end());
  const auto at = [&](double share) {
    return costs[std::min(costs.size() - 1,
                          static_cast<std::size_t>(share * static_cast<double>(costs.size())))];
  };
  std::printf("%-8s %-8s median %6.2f us  p99 %6.2f us  p99.9 %7.2f us  max %8.2f us\n",
              coupling.c_str(),
              site,
              at(0.5),
              at(0.99),
              at(0.999),
              costs.back());
  return at(0.5) <= kMedianMax;
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const palp::DenormalFlush flush;
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 30;
  if (argc > 2 && std::string_view{argv[2]} == "filtered") {
    if (const auto refused = palp::io::refuse_system_calls()) {
      std::fprintf(stderr, "%s\n", refused->c_str());
      return 2;
    }
  }
  bool good = seconds > 0;
  if (!good) std::fprintf(stderr, "site_tick_bench: SECONDS must be a whole number above 0\n");
  for (const std::string_view name : palp::coupling::kCouplingNames) {
    if (seconds <= 0) break;
    auto costs = palp::bench::measure(std::string{name}, std::chrono::seconds{seconds});
    good &= palp::bench::report(std::string{name}, "surgeon", costs.surgeon);
    good &= palp::bench::report(std::string{name}, "patient", costs.patient);
  }
  return good ? 0 : 1;
}
