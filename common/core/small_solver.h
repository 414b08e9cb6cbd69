#pragma once

#include <array>
#include <cstddef>

/// Symmetric positive definite systems of a few equations, as least squares make them.
namespace palp {

template <std::size_t N>
struct SmallSystem {
  std::array<std::array<double, N>, N> matrix{};  ///< [user's]; right of its diagonal unread
  std::array<double, N> right{};                  ///< [user's]
};

template <std::size_t N>
struct SmallSolution {
  std::array<double, N> x{};  ///< [user's]
  double explained{};         ///< [user's], x . right: what x takes off a sum of squares
  bool regular{};             ///< false: the equations leave an unknown open; the rest is 0
};

/// A pivot this small against its diagonal is rounding, not information.
inline constexpr double kPivotMin = 1e-13;  // [-]

/// Over the unknowns that are `open`; the others stay 0 and their equations out. By elimination
/// without exchange of rows, which symmetric positive definite systems do not need.
/// Thread: any, rt too: allocates nothing, N^3 steps at most.
template <std::size_t N>
[[nodiscard]] SmallSolution<N> solve(const SmallSystem<N>& system,
                                     const std::array<bool, N>& open) noexcept {
  std::array<std::size_t, N> map{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < N; ++i) {
    if (open[i]) map[count++] = i;
  }
  std::array<std::array<double, N>, N> m{};
  std::array<double, N> y{};
  for (std::size_t r = 0; r < count; ++r) {
    y[r] = system.right[map[r]];
    for (std::size_t k = 0; k <= r; ++k) m[r][k] = m[k][r] = system.matrix[map[r]][map[k]];
  }
  SmallSolution<N> solution;
  double explained = 0;
  for (std::size_t r = 0; r < count; ++r) {
    if (!(m[r][r] > kPivotMin * system.matrix[map[r]][map[r]])) return solution;
    const double inverse = 1 / m[r][r];
    explained += y[r] * y[r] * inverse;
    for (std::size_t below = r + 1; below < count; ++below) {
      const double factor = m[below][r] * inverse;
      for (std::size_t k = r + 1; k < count; ++k) m[below][k] -= factor * m[r][k];
      y[below] -= factor * y[r];
    }
  }
  for (std::size_t r = count; r-- > 0;) {
    for (std::size_t k = r + 1; k < count; ++k) y[r] -= m[r][k] * y[k];
    y[r] /= m[r][r];
    solution.x[map[r]] = y[r];
  }
  solution.explained = explained;
  solution.regular = true;
  return solution;
}

/// Over all unknowns.
template <std::size_t N>
[[nodiscard]] SmallSolution<N> solve(const SmallSystem<N>& system) noexcept {
  std::array<bool, N> open{};
  open.fill(true);
  return solve(system, open);
}

}  // namespace palp
