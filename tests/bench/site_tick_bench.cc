// What one tick of a site costs, for every coupling: site_tick_bench [SECONDS]
// Both nodes with real telegrams, records and simulated devices, on a path of 20 ms with jitter and
// loss; the script palpates. Each tick is timed by itself, in microseconds. Exit code 1: the median
// of a node is above 20 us.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <time.h>

#include "common/core/denormals.h"
#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/link/codec_wire.h"
#include "common/record/queue_recorder.h"
#include "lab/meeting.h"
#include "lab/scenario_file.h"
#include "netem/impairment.h"
#include "netem/pipe.h"
#include "patient_site/estimator_worker.h"
#include "patient_site/patient_node.h"
#include "surgeon_site/surgeon_node.h"

namespace palp::bench {
namespace {

constexpr double kMedianMax = 20;  ///< [us]
constexpr std::size_t kQueue = 8192;

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
  lab::Scenario scenario =
      lab::make_scenario("standard", lab::load_scenario("standard").value()).value();
  scenario.coupling.name = coupling;
  scenario.up = netem::parse_impairment("delay 10ms 1ms distribution normal loss 1%").value();
  scenario.down = scenario.up;

  TimePoint now{std::chrono::seconds{1}};
  netem::Pipe pipe{scenario.up, scenario.down, 1, kQueue, now};
  link::Link surgeon_link{scenario.link, std::make_unique<link::WireCodec>()};
  link::Link patient_link{scenario.link, std::make_unique<link::WireCodec>()};
  lab::Meeting surgeon_meeting{scenario, link::Role::Surgeon, pipe.surgeon_end()};
  lab::Meeting patient_meeting{scenario, link::Role::Patient, pipe.patient_end()};
  surgeon_meeting.start(surgeon_link, now);
  patient_meeting.start(patient_link, now);
  record::QueueRecorder surgeon_records{kQueue};
  record::QueueRecorder patient_records{kQueue};

  surgeon::SimulatedHand hand{scenario.hand, scenario.script};
  auto surgeon_law = coupling::make_surgeon_coupling(scenario.coupling).value();
  surgeon::SurgeonNode surgeon{scenario.surgeon,
                               {hand, surgeon_law, surgeon_link, surgeon_records}};
  patient::SimulatedPhantom tissue{scenario.phantom, scenario.tissue};
  auto patient_law = coupling::make_patient_coupling(scenario.coupling).value();
  SpscQueue<ContactSample> contact{kQueue};
  Mailbox<DepthEstimate> depth;
  patient::PatientNode patient{
      scenario.patient,
      {tissue, tissue, patient_law, patient_link, patient_records, contact, depth}};

  Costs costs;
  for (const TimePoint end = now + span; now < end;) {
    now += scenario.link.period;
    const double begin = now_us();
    surgeon.tick(now);
    const double between = now_us();
    patient.tick(now);
    const double done = now_us();
    costs.surgeon.push_back(between - begin);
    costs.patient.push_back(done - between);
    surgeon_records.drain([](const record::Record&) {});
    patient_records.drain([](const record::Record&) {});
    ContactSample sample;
    while (contact.try_dequeue(sample)) continue;
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
