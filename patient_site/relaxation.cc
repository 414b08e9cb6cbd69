#include "patient_site/relaxation.h"

#include <cmath>

namespace palp::patient {

/// exp(-sqrt(t/T)) is a sum over rates k of exp(-k t), of which those below k are
/// erfc(1/(2 sqrt(k T))) (Laplace): cut into parts by the mean of their logarithms.
Relaxation stretched_relaxation(double share, double time) noexcept {
  constexpr double kSlowest = 0.03;  // [-], least rate in units of 1/time, beyond it all is one
  constexpr double kPace = 3;        // [-], of rates
  const auto below = [](double rate) { return std::erfc(0.5 / std::sqrt(rate)); };
  Relaxation relaxation;
  double rate = kSlowest;
  double before = 0;
  for (std::size_t k = 0; k < Relaxation::kParts; ++k, rate *= kPace) {
    const double until = k + 1 < Relaxation::kParts ? below(rate * std::sqrt(kPace)) : 1;
    relaxation.parts[k] = {.share = share * (until - before), .time = time / rate};
    before = until;
  }
  return relaxation;
}

}  // namespace palp::patient
