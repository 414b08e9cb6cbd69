#include "common/coupling/rounding.h"

#include <cmath>
#include <numbers>

namespace palp::coupling {

/// The mean square is 2 sum over j of (2j + 1) Q((j + 1/2)/s).
double noise_over_quantum(double mean_square_over_quantum) noexcept {
  double low = 0.01;
  double high = 20;
  for (int i = 0; i < 40; ++i) {
    const double s = 0.5 * (low + high);
    if (s > 1) {  // finer than the noise: rounding adds its twelfth
      (s * s + 1.0 / 12 > mean_square_over_quantum ? high : low) = s;
      continue;
    }
    double mean_square = 0;
    for (int j = 0; j < 8; ++j) {
      mean_square += (2 * j + 1) * std::erfc((j + 0.5) / s / std::numbers::sqrt2);
    }
    (mean_square > mean_square_over_quantum ? high : low) = s;
  }
  return 0.5 * (low + high);
}

}  // namespace palp::coupling
