#include "study/signal_detection.h"

#include <cmath>

#include "common/core/random.h"

namespace palp::study {
namespace {

struct Score {
  double z{};         // [-]
  double variance{};  // [-]
};

Score score(std::size_t yes, std::size_t trials) noexcept {
  const double n = static_cast<double>(trials) + 1;
  const double share = (static_cast<double>(yes) + 0.5) / n;
  const double z = normal_quantile(share);
  const double density = std::exp(-0.5 * z * z) * 0.398942280401432678;
  return {z, share * (1 - share) / (n * density * density)};
}

}  // namespace

Sensitivity sensitivity(const YesNoCounts& counts) noexcept {
  const Score hit = score(counts.hits, counts.signals);
  const Score alarm = score(counts.false_alarms, counts.blanks);
  const double sd = std::sqrt(hit.variance + alarm.variance);
  return {hit.z - alarm.z, -(hit.z + alarm.z) / 2, sd, sd / 2};
}

}  // namespace palp::study
