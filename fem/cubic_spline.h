#pragma once

#include <vector>

#include <Eigen/Core>

namespace palp::fem {

/// How a function goes on beyond x = 0: f(-x) = f(x), or f(-x) = -f(x).
enum class Parity { Even, Odd };

/// Interpolating cubic spline over fixed places, as a linear map from values to values: what many
/// functions over the same places share. From x = 0, where the function is even or odd; without
/// curvature at the last place. A value. Thread: any.
class CubicSpline {
 public:
  /// `places` [as x] rise from 0; at least three.
  CubicSpline(std::vector<double> places, Parity parity);

  /// Row by row the weights of the values at the places in the value at each x. Each x lies in
  /// [0, last place].
  [[nodiscard]] Eigen::MatrixXd weights(const std::vector<double>& x) const;

 private:
  std::vector<double> places_;  ///< [as x]
  Eigen::MatrixXd curvature_;   ///< second derivatives at the places over the values there
};

}  // namespace palp::fem
