#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palp::depth {

/// What the unknowns that went explain of the square, and the logarithm of their determinant.
struct Eliminated {
  double explained{};        ///< [-]
  double log_determinant{};  ///< [-]
};

/// Normal equations, lower triangle and right side, changed in place: the first `count` unknowns
/// go, the others keep what is left. A pivot that is not above 0 counts as next to nothing.
template <std::size_t N>
Eliminated eliminate(std::array<std::array<double, N>, N>& m,
                     std::array<double, N>& y,
                     std::size_t count) noexcept {
  Eliminated out;
  for (std::size_t r = 0; r < count; ++r) {
    const double pivot = std::max(m[r][r], std::numeric_limits<double>::min());
    const double inverse = 1 / pivot;
    out.explained += y[r] * y[r] * inverse;
    out.log_determinant += std::log(pivot);
    for (std::size_t below = r + 1; below < N; ++below) {
      const double factor = m[below][r] * inverse;
      for (std::size_t k = r + 1; k <= below; ++k) m[below][k] -= factor * m[k][r];
      y[below] -= factor * y[r];
    }
  }
  return out;
}

}  // namespace palp::depth
