// How much processor time the estimator takes from the sample that shows a reversal to its answer,
// stroke after stroke over many phantoms. One line each; exit code 1 if the 99 % quantile is above
// 5 ms.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <time.h>

#include "common/core/filters.h"
#include "patient_site/estimator/depth_estimator.h"
#include "patient_site/phantom.h"
#include "patient_site/simulated_phantom.h"

namespace palp::patient {
namespace {

/// Time of this thread alone, so that what else runs on the machine does not count.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Milliseconds of every answer: four taps beside, four over the inclusion.
std::vector<double> palpate(const std::string& spec, std::uint64_t seed) {
  const auto phantom = make_phantom(spec);
  if (!phantom) {
    std::fprintf(stderr, "%s\n", phantom.error().text.c_str());
    std::exit(2);
  }
  const double reach = std::min(4e-3, phantom->depth_max() - 0.1e-3) + 3e-3;
  estimator::DepthEstimator estimator{{}};
  std::vector<double> out;
  TimePoint now{};
  for (const double lateral : {0.0, 20e-3}) {
    SimulatedPhantomConfig sensor;
    sensor.start_position = -3e-3;
    sensor.start_lateral = lateral;
    sensor.seed = seed + static_cast<std::uint64_t>(lateral * 1e3);
    SimulatedPhantom site{*phantom, sensor};
    LowPass co_filter{20, 1e-3};
    co_filter.reset(-3e-3);
    for (int i = 0; i < 4 * 1200; ++i) {
      now += std::chrono::milliseconds{1};
      const StageState stage = site.read(now);
      const auto force = site.sample(now);
      const ContactSample sample{.at = now,
                                 .position = co_filter.step(stage.position),
                                 .force = force->force,
                                 .lateral = lateral};
      const double before = processor_ms();
      const auto estimate = estimator.add(sample);
      const double took = processor_ms() - before;
      if (estimate) out.push_back(took);
      const double t = std::min(i % 1200 * 1e-3, 1.0);
      site.move_to({-3e-3 + 0.5 * reach * (1 - std::cos(2 * std::numbers::pi * t)), lateral});
    }
  }
  return out;
}

int run() {
  std::vector<double> all;
  std::uint64_t seed = 1;
  for (const int depth : {4, 6, 9, 13, 18, 24}) {
    for (const int radius : {3, 8, 15}) {
      for (const int ratio : {4, 30, 800}) {
        char spec[96];
        std::snprintf(spec, sizeof spec, "ball depth=%d radius=%d ratio=%d", depth, radius, ratio);
        const std::vector<double> one = palpate(spec, ++seed);
        std::printf("%-36s %2zu answers, slowest %6.2f ms\n",
                    spec,
                    one.size(),
                    *std::max_element(one.begin(), one.end()));
        all.insert(all.end(), one.begin(), one.end());
      }
    }
  }
  std::sort(all.begin(), all.end());
  const auto quantile = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  std::printf("%zu answers: median %.2f ms, 99 %% %.2f ms, slowest %.2f ms\n",
              all.size(),
              quantile(0.5),
              quantile(0.99),
              all.back());
  return quantile(0.99) <= 5 ? 0 : 1;
}

}  // namespace
}  // namespace palp::patient

int main() { return palp::patient::run(); }
