#include "patient_site/estimator/curve_match.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::estimator {
namespace {

constexpr double kStep = 25e-6;  // [m], of the basis' table
constexpr double kBin = 0.1e-3;  // [m], points closer than this are one

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;

/// Inverse of a symmetric positive matrix, and its determinant.
double invert(const Matrix3& m, Matrix3& out) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3;
      const std::size_t b = (j + 2) % 3;
      const std::size_t c = (i + 1) % 3;
      const std::size_t d = (i + 2) % 3;
      out[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  }
  const double det = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  for (auto& row : out) {
    for (double& value : row) value /= det;
  }
  return det;
}

double dot(const CurveTerms& a, const CurveTerms& b) noexcept {
  double sum = 0;
  for (std::size_t m = 0; m < kCurveTerms; ++m) sum += a[m] * b[m];
  return sum;
}

double bilinear(const CurveTerms& a,
                const std::array<CurveTerms, kCurveTerms>& form,
                const CurveTerms& b) noexcept {
  double sum = 0;
  for (std::size_t m = 0; m < kCurveTerms; ++m) sum += a[m] * dot(form[m], b);
  return sum;
}

/// What is known of (e, e s, e v) beforehand: information and mean.
struct Known {
  Vector3 weight{};
  Vector3 mean{};
};

Known known(const StiffnessPrior& stiffness) noexcept {
  const double rate_width = stiffness.scale * stiffness.rate_factor_stddev;
  return {.weight = {1 / (stiffness.scale_stddev * stiffness.scale_stddev),
                     1 / (kSurfaceSpread * kSurfaceSpread),
                     1 / (rate_width * rate_width)},
          .mean = {stiffness.scale, 0, stiffness.scale * stiffness.rate_factor}};
}

}  // namespace

CurveBasis::CurveBasis(const fem::DepthDatabase& database) {
  const auto plain = database.plain();
  const auto count = static_cast<std::size_t>(kCurveReach / kStep) + 2;
  const auto at = [&](double indentation) {
    CurveTerms out = curve_polynomials(indentation);
    const double force = database.force(plain, indentation);
    for (double& term : out) term *= force;
    return out;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double indentation = static_cast<double>(i) * kStep;
    Row row{.force = at(indentation), .slope = {}};
    const double low = std::max(0.0, indentation - 0.1 * kStep);
    const double high = std::min(kCurveReach, indentation + 0.1 * kStep);
    const CurveTerms before = at(low);
    const CurveTerms behind = at(high);
    for (std::size_t m = 0; m < kCurveTerms; ++m) {
      row.slope[m] = (behind[m] - before[m]) / (high - low);
    }
    rows_.push_back(row);
  }
}

CurveBasis::Row CurveBasis::at(double indentation) const noexcept {
  if (!(indentation > 0)) return {};
  const double place = std::min(indentation / kStep, static_cast<double>(rows_.size()) - 1.001);
  const auto entry = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(entry);
  Row out;
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    const Row& low = rows_[entry];
    const Row& high = rows_[entry + 1];
    out.force[m] = low.force[m] + share * (high.force[m] - low.force[m]);
    out.slope[m] = low.slope[m] + share * (high.slope[m] - low.slope[m]);
  }
  return out;
}

CurveMatcher::CurveMatcher(const CurveBasis& basis, const Input& input)
    : noise_{input.noise}, stiffness_{input.stiffness} {
  // Loading and unloading stay apart: points come branch by branch, in order of position.
  double begin = -std::numeric_limits<double>::infinity();
  ContactPoint sum;
  const auto finish = [&] {
    if (!(sum.count > 0)) return;
    const ContactPoint mean{
        sum.position / sum.count, sum.force / sum.count, sum.rate / sum.count, sum.count};
    sum = {};
    const double indentation = mean.position - input.surface;
    if (indentation > kDeepestPoint || indentation < -kSurfaceSpread) return;
    add(basis, mean, indentation);
  };
  for (const ContactPoint& point : input.points) {
    if (point.position > begin + kBin || point.position < begin) {
      finish();
      begin = point.position;
    }
    sum.position += point.count * point.position;
    sum.force += point.count * point.force;
    sum.rate += point.count * point.rate;
    sum.count += point.count;
  }
  finish();
}

void CurveMatcher::add(const CurveBasis& basis, const ContactPoint& point, double indentation) {
  const double weight = point.count / (noise_ * noise_);
  const CurveBasis::Row row = basis.at(indentation);
  std::array<CurveTerms, 3> x{row.force, row.slope, row.force};
  for (std::size_t m = 0; m < kCurveTerms; ++m) {
    x[1][m] = -x[1][m];
    x[2][m] *= point.rate;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      for (std::size_t m = 0; m < kCurveTerms; ++m) {
        const double left = weight * x[i][m];
        for (std::size_t n = 0; n < kCurveTerms; ++n) forms_[i][j][m][n] += left * x[j][n];
      }
    }
    for (std::size_t m = 0; m < kCurveTerms; ++m) right_[i][m] += weight * x[i][m] * point.force;
  }
  squares_ += weight * point.force * point.force;
  weights_ += weight;
}

/// Least squares for (e, e s, e v): force = e F(x) + e s (-F'(x)) + e v F(x) rate.
CurveMatch CurveMatcher::match(const CurveTerms& curve) const noexcept {
  const Known prior = known(stiffness_);
  Matrix3 normal{};
  Vector3 right{};
  double squares = squares_;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      normal[i][j] = bilinear(curve, forms_[i][j], curve);
      normal[j][i] = normal[i][j];
    }
    normal[i][i] += prior.weight[i];
    right[i] = dot(right_[i], curve) + prior.weight[i] * prior.mean[i];
    squares += prior.weight[i] * prior.mean[i] * prior.mean[i];
  }
  Matrix3 inverse{};
  const double det = invert(normal, inverse);
  Vector3 solution{};
  double explained = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) solution[i] += inverse[i][j] * right[j];
    explained += solution[i] * right[i];
  }
  CurveMatch out;
  out.misfit = squares - explained;
  out.log_likelihood = -0.5 * out.misfit - 0.5 * std::log(det);
  out.scale = solution[0];
  out.scale_stddev = std::sqrt(inverse[0][0]);
  out.rate_factor = solution[2] / solution[0];
  out.rate_factor_stddev = std::sqrt(inverse[2][2]) / solution[0];
  out.shift = solution[1] / solution[0];
  return out;
}

CurveMatcher::Information CurveMatcher::information(
    const CurveTerms& curve, const std::array<CurveTerms, 3>& along) const noexcept {
  const Known prior = known(stiffness_);
  Matrix3 normal{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      normal[i][j] = bilinear(curve, forms_[i][j], curve);
      normal[j][i] = normal[i][j];
    }
    normal[i][i] += prior.weight[i];
  }
  Matrix3 inverse{};
  (void)invert(normal, inverse);
  std::array<Vector3, 3> cross{};  // by coordinate and unknown
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) cross[i][j] = bilinear(along[i], forms_[0][j], curve);
  }
  const double square = stiffness_.scale * stiffness_.scale;
  Information out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = bilinear(along[i], forms_[0][0], along[j]);
      for (std::size_t m = 0; m < 3; ++m) {
        for (std::size_t n = 0; n < 3; ++n) sum -= cross[i][m] * inverse[m][n] * cross[j][n];
      }
      out[i][j] = square * sum;
    }
  }
  return out;
}

}  // namespace palp::estimator
