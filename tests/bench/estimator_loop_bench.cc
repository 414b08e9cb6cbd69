// Whether the depth estimator disturbs the 1 kHz loop beside it: estimator_loop_bench [ROUNDS]
// Both nodes tick on one thread in real time while the script palpates; another thread, as in
// palp-patient, estimates depths, or only empties the queue. A round is 20 s of each, in turn. Of
// both: periods missed per 1,000, how late ticks begin, how long after a reversal's sample the
// answer was there.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "common/io/realtime/background_loop.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/estimator_worker.h"
#include "tests/bench/two_sites.h"

namespace palp::bench {
namespace {

constexpr int kPriority = 80;
constexpr auto kSpan = std::chrono::seconds{20};
constexpr auto kPause = std::chrono::milliseconds{1};  // of the estimator's thread, as at the site

class NoRecorder final : public record::Recorder {
 public:
  bool record(const Record&) noexcept override { return true; }
};

struct Account {
  io::LoopStats loop;
  std::vector<double> answers;  ///< [ms]
};

Account run_loop(bool estimating) {
  const io::SteadyClock clock;
  TwoSites sites{standard_scenario("mmt"), clock.now()};
  NoRecorder recorder;
  patient::EstimatorWorker worker{{}, {sites.contact(), sites.found(), sites.cells(), recorder}};
  Account account;
  std::uint64_t strokes = 0;
  io::BackgroundLoop listening{
      "bench-estimator", kPause, [&](TimePoint) {
        if (!estimating) {
          sites.drop_contact();
          return;
        }
        worker.drain();
        if (worker.strokes() == strokes) return;
        strokes = worker.strokes();
        account.answers.push_back(1e3 * seconds(clock.now() - worker.reversal_at()));
      }};
  io::PeriodicThread loop{"bench-rt", {.priority = kPriority}, [&](TimePoint now) {
                            sites.tick_surgeon(now);
                            sites.tick_patient(now);
                            sites.drop_records();
                          }};
  std::this_thread::sleep_for(kSpan);
  account.loop = loop.stop();
  listening.stop();
  return account;
}

void print(const char* name, const Account& account) {
  const io::LoopStats& loop = account.loop;
  const auto us = [](Duration span) { return 1e6 * seconds(span); };
  std::printf(
      "%-18s missed %5.2f per 1,000  late p50 %6.1f us  p99 %7.1f  p99.9 %7.1f  max %8.1f",
      name,
      1e3 * static_cast<double>(loop.missed) / static_cast<double>(loop.ticks + loop.missed),
      us(loop.lateness_p50),
      us(loop.lateness_p99),
      us(loop.lateness_p999),
      us(loop.lateness_max));
  if (!account.answers.empty()) {
    std::printf("  %zu answers, slowest after %.2f ms",
                account.answers.size(),
                *std::max_element(account.answers.begin(), account.answers.end()));
  }
  std::printf("\n");
}

}  // namespace
}  // namespace palp::bench

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 2;
  for (int round = 0; round < rounds; ++round) {
    palp::bench::print("with estimator", palp::bench::run_loop(true));
    palp::bench::print("without estimator", palp::bench::run_loop(false));
  }
  return 0;
}
