#pragma once

#include <array>
#include <cstddef>

#include "common/core/small_solver.h"

/// Least squares of a few unknowns that are no less than 0 (Lawson and Hanson, Solving Least
/// Squares Problems, ch. 23).
namespace palp::coupling {

template <std::size_t N>
class Nonnegative {
 public:
  using Unknowns = std::array<double, N>;

  /// `scale` [user's], > 0: of each unknown, so that their gains can be compared.
  Nonnegative(const SmallSystem<N>& system, const Unknowns& scale) noexcept
      : system_{system}, scale_{scale} {}

  /// Makes `x` >= 0 the best there is: an active set that starts from it and grows or shrinks by
  /// one unknown at a time, 2 N times at most. Both triangles of the matrix are read.
  void improve(Unknowns& x) const noexcept {
    std::array<bool, N> used{};
    for (std::size_t row = 0; row < N; ++row) used[row] = x[row] > 0;
    for (std::size_t round = 0; round < 2 * N; ++round) {
      const SmallSolution<N> least = solve(system_, used);
      if (!least.regular) return;
      const std::size_t leaves = approach(x, least.x, used);
      if (leaves < N) {
        x[leaves] = 0;
        used[leaves] = false;
        continue;
      }
      const std::size_t joins = steepest_of(x, used);
      if (joins == N) return;
      used[joins] = true;
    }
  }

 private:
  /// Moves `x` towards `least` as far as none becomes negative. @returns the one that is then 0 and
  /// leaves; N: none.
  static std::size_t approach(Unknowns& x,
                              const Unknowns& least,
                              const std::array<bool, N>& used) noexcept {
    double way = 1;
    std::size_t leaves = N;
    for (std::size_t row = 0; row < N; ++row) {
      if (!used[row] || least[row] > 0) continue;
      const double share = x[row] > 0 ? x[row] / (x[row] - least[row]) : 0;
      if (share <= way) {
        way = share;
        leaves = row;
      }
    }
    for (std::size_t row = 0; row < N; ++row) {
      if (used[row]) x[row] += way * (least[row] - x[row]);
    }
    return leaves;
  }

  /// The one out of use that would help most; N: none would.
  [[nodiscard]] std::size_t steepest_of(const Unknowns& x,
                                        const std::array<bool, N>& used) const noexcept {
    double steepest = 1e-12;
    std::size_t joins = N;
    for (std::size_t row = 0; row < N; ++row) {
      if (used[row]) continue;
      double gain = system_.right[row];
      for (std::size_t column = 0; column < N; ++column) {
        gain -= system_.matrix[row][column] * x[column];
      }
      const double relative = gain * scale_[row];
      if (relative > steepest) {
        steepest = relative;
        joins = row;
      }
    }
    return joins;
  }

  const SmallSystem<N>& system_;
  const Unknowns& scale_;
};

}  // namespace palp::coupling
