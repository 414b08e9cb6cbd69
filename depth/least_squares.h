#pragma once

#include <array>
#include <cmath>
#include <cstddef>

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
      for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] += weighted * regressors[j];
      vector_[i] += weighted * value;
    }
    squares_ += weight * value * value;
  }

  /// Prior knowledge of unknown `i`: x_i = `mean` with 1/variance `weight`.
  void add_prior(std::size_t i, double mean, double weight) noexcept {
    matrix_[i][i] += weight;
    vector_[i] += weight * mean;
    squares_ += weight * mean * mean;
  }

  struct Solution {
    std::array<double, N> x{};  ///< [of the model]
    double cost{};              ///< [-], sum of weighted squared residuals at x, priors included
    bool regular{};
  };

  /// By Cholesky. Not regular: the samples do not determine the unknowns.
  [[nodiscard]] Solution solve() const noexcept {
    Solution solution;
    std::array<std::array<double, N>, N> lower{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = matrix_[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        if (j < i) {
          lower[i][j] = sum / lower[j][j];
        } else {
          // A pivot this small against its diagonal is rounding, not information.
          if (!(sum > 1e-13 * matrix_[i][i])) return solution;
          lower[i][i] = std::sqrt(sum);
        }
      }
    }
    std::array<double, N> half{};
    solution.cost = squares_;
    for (std::size_t i = 0; i < N; ++i) {
      double sum = vector_[i];
      for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * half[k];
      half[i] = sum / lower[i][i];
      solution.cost -= half[i] * half[i];
    }
    for (std::size_t i = N; i-- > 0;) {
      double sum = half[i];
      for (std::size_t k = i + 1; k < N; ++k) sum -= lower[k][i] * solution.x[k];
      solution.x[i] = sum / lower[i][i];
    }
    solution.regular = true;
    return solution;
  }

 private:
  std::array<std::array<double, N>, N> matrix_{};  ///< [-], lower triangle
  std::array<double, N> vector_{};                 ///< [-]
  double squares_{};                               ///< [-]
};

}  // namespace palp::depth
