#include "patient_site/estimator/curve_match.h"

#include <cmath>

namespace palp::estimator {

/// Scale e and rate factor v are known with their covariance; of (e, e v) that is, to first order,
/// what the product makes of it.
CurveMatcher::CurveMatcher(const NormalEquations& sums,
                           const StiffnessPrior& stiffness,
                           double surface)
    : sums_{sums}, scale_{stiffness.scale} {
  const double e = stiffness.scale;
  const double v = stiffness.rate_factor;
  const double var_e = stiffness.scale_stddev * stiffness.scale_stddev;
  const double var_v = stiffness.rate_factor_stddev * stiffness.rate_factor_stddev;
  const double both = stiffness.correlation * stiffness.scale_stddev * stiffness.rate_factor_stddev;
  const double var_ev = e * e * var_v + v * v * var_e + 2 * e * v * both;
  const double cross = v * var_e + e * both;
  const double det = var_e * var_ev - cross * cross;
  known_[0][0] = var_ev / det;
  known_[0][2] = known_[2][0] = -cross / det;
  known_[2][2] = var_e / det;
  known_[1][1] = 1 / (e * e * kSurfaceSpread * kSurfaceSpread);
  const Vector3 mean{e, e * (surface - sums.surface()), e * v};
  known_square_ = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) right_[i] += known_[i][j] * mean[j];
    known_square_ += right_[i] * mean[i];
  }
}

Matrix3 CurveMatcher::normal_matrix(const CurveTerms& curve) const noexcept {
  Matrix3 normal = known_;
  for (std::size_t i = 0; i < 3; ++i) {
    const NormalEquations::Columns rows = sums_.rows(i, curve);
    for (std::size_t j = i; j < 3; ++j) {
      normal[i][j] += NormalEquations::between(rows, j, curve);
      normal[j][i] = normal[i][j];
    }
  }
  return normal;
}

/// Least squares for (e, e s, e v): force = e F(x) + e s (-F'(x)) + e v F(x) rate.
CurveMatch CurveMatcher::match(const CurveTerms& curve) const noexcept {
  const Inverse3 covariance = inverse(normal_matrix(curve));
  Vector3 right = right_;
  for (std::size_t i = 0; i < 3; ++i) right[i] += sums_.along(i, curve);
  Vector3 solution{};
  double explained = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) solution[i] += covariance.matrix[i][j] * right[j];
    explained += solution[i] * right[i];
  }
  CurveMatch out;
  out.misfit = sums_.squares() + known_square_ - explained;
  out.log_likelihood = -0.5 * out.misfit - 0.5 * std::log(covariance.determinant);
  const double e = solution[0];
  const double v = solution[2] / e;
  const Matrix3& c = covariance.matrix;
  out.stiffness.scale = e;
  out.stiffness.scale_stddev = std::sqrt(c[0][0]);
  out.stiffness.rate_factor = v;
  out.stiffness.rate_factor_stddev =
      std::sqrt(c[2][2] - 2 * v * c[0][2] + v * v * c[0][0]) / std::abs(e);
  out.stiffness.correlation =
      (c[0][2] - v * c[0][0]) / (e * out.stiffness.scale_stddev * out.stiffness.rate_factor_stddev);
  out.shift = solution[1] / e;
  return out;
}

CurveMatcher::Information CurveMatcher::information(
    const CurveTerms& curve, const std::array<CurveTerms, 3>& along) const noexcept {
  const Matrix3 covariance = inverse(normal_matrix(curve)).matrix;
  std::array<Vector3, 3> cross{};  // by coordinate and unknown
  std::array<NormalEquations::Columns, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    rows[i] = sums_.rows(0, along[i]);
    for (std::size_t j = 0; j < 3; ++j) cross[i][j] = NormalEquations::between(rows[i], j, curve);
  }
  const double square = scale_ * scale_;
  Information out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = NormalEquations::between(rows[i], 0, along[j]);
      for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t n = 0; n < 3; ++n) sum -= cross[i][m] * covariance[m][n] * cross[j][n];
      }
      out[i][j] = square * sum;
    }
  }
  return out;
}

}  // namespace palp::estimator
