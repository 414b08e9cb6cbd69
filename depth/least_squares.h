#pragma once

#include <array>
#include <cstddef>

#include "common/core/small_solver.h"

namespace palp::depth {

/// Normal equations of a linear least-squares problem with `N` unknowns, a sum over samples: add,
/// then solve. Scale the regressors to order one before. Thread: its owner's.
template <std::size_t N>
class LeastSquares {
 public:
  /// One equation: regressors . x = value, counted `weight` >= 0 times.
  void add(const std::array<double, N>& regressors, double value, double weight = 1) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      const double weighted = weight * regressors[i];
      for (std::size_t j = 0; j <= i; ++j) system_.matrix[i][j] += weighted * regressors[j];
      system_.right[i] += weighted * value;
    }
    squares_ += weight * value * value;
  }

  /// Prior knowledge of unknown `i`: x_i = `mean` with 1/variance `weight`.
  void add_prior(std::size_t i, double mean, double weight) noexcept {
    system_.matrix[i][i] += weight;
    system_.right[i] += weight * mean;
    squares_ += weight * mean * mean;
  }

  struct Solution {
    std::array<double, N> x{};  ///< [of the model]
    double cost{};              ///< [-], sum of weighted squared residuals at x, priors included
    bool regular{};
  };

  /// Not regular: the samples do not determine the unknowns.
  [[nodiscard]] Solution solve() const noexcept {
    const SmallSolution<N> found = palp::solve(system_);
    return {found.x, squares_ - found.explained, found.regular};
  }

 private:
  SmallSystem<N> system_;
  double squares_{};  ///< [-]
};

}  // namespace palp::depth
