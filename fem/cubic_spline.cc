#include "fem/cubic_spline.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "common/core/check.h"
#include "fem/dense_solver.h"

namespace palp::fem {

CubicSpline::CubicSpline(std::vector<double> places, Parity parity) : places_{std::move(places)} {
  PALP_CHECK(places_.size() >= 3 && places_.front() == 0, "a spline has three places from 0 on");
  PALP_CHECK(
      std::adjacent_find(places_.begin(), places_.end(), std::greater_equal<>{}) == places_.end(),
      "a spline's places rise");
  const auto count = static_cast<Eigen::Index>(places_.size());
  const auto step = [&](Eigen::Index i) {
    return places_[static_cast<std::size_t>(i) + 1] - places_[static_cast<std::size_t>(i)];
  };
  // Slopes of both sides agree at every inner place.
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 1; i + 1 < count; ++i) {
    left(i, i - 1) = step(i - 1) / 6;
    left(i, i) = (step(i - 1) + step(i)) / 3;
    left(i, i + 1) = step(i) / 6;
    right(i, i - 1) = 1 / step(i - 1);
    right(i, i) = -1 / step(i - 1) - 1 / step(i);
    right(i, i + 1) = 1 / step(i);
  }
  left(count - 1, count - 1) = 1;
  if (parity == Parity::Odd) {
    left(0, 0) = 1;
  } else {
    left(0, 0) = step(0) / 3;
    left(0, 1) = step(0) / 6;
    right(0, 0) = -1 / step(0);
    right(0, 1) = 1 / step(0);
  }
  curvature_ = solve(left, right);
}

Eigen::MatrixXd CubicSpline::weights(const std::vector<double>& x) const {
  const auto rows = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, curvature_.cols());
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double at = x[static_cast<std::size_t>(row)];
    PALP_CHECK(at >= 0 && at <= places_.back(), "no spline beyond its places");
    const auto above = std::upper_bound(places_.begin() + 1, places_.end() - 1, at);
    const auto i = static_cast<Eigen::Index>(above - places_.begin()) - 1;
    const double low = *(above - 1);
    const double h = *above - low;
    const double t = (at - low) / h;
    const double s = 1 - t;
    out.row(row) =
        h * h / 6 * ((s * s * s - s) * curvature_.row(i) + (t * t * t - t) * curvature_.row(i + 1));
    out(row, i) += s;
    out(row, i + 1) += t;
  }
  return out;
}

}  // namespace palp::fem
