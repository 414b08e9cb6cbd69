// How much processor time the estimator takes from the sample that shows a reversal to its answer,
// stroke after stroke over many phantoms. One line each; exit code 1 if the 99 % quantile is above
// 5 ms.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <time.h>

#include "depth/depth_estimator.h"
#include "patient_site/phantom.h"
#include "tests/depth/tapping.h"

namespace palp::patient {
namespace {

/// Time of this thread alone, so that what else runs on the machine does not count.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Milliseconds of every answer: four taps beside, four over the inclusion.
std::vector<double> answers_over(const std::string& spec, std::uint64_t seed) {
  const auto phantom = make_phantom(spec);
  if (!phantom) {
    std::fprintf(stderr, "%s\n", phantom.error().text.c_str());
    std::exit(2);
  }
  const Tapping tapping{
      .taps = 4, .indentation = std::min(4e-3, phantom->depth_max() - 0.1e-3), .rest_time = 0.2};
  depth::DepthEstimator estimator{{}};
  std::vector<double> out;
  palpate(*phantom, {.seed = seed}, tapping, [&](const ContactSample& sample) {
    const double before = processor_ms();
    const auto estimate = estimator.add(sample);
    const double took = processor_ms() - before;
    if (estimate) out.push_back(took);
  });
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
        const std::vector<double> one = answers_over(spec, ++seed);
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
