#include "fem/depth_formula.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include <ceres/ceres.h>

#include "common/core/check.h"
#include "fem/dense_solver.h"

namespace palp::fem {
namespace {

constexpr double kHashScale = 0.01;   // [N]: hashes differ by a few of it
constexpr double kPoleMargin = 1e-5;  // [N], of the pole below the smallest hash

/// Eq. (3) in u = (h - origin) / scale, where its coefficients are of one size.
struct DepthResidual {
  double u{};      ///< [-]
  double depth{};  ///< [mm]
  template <typename T>
  bool operator()(const T* const coefficients, const T* const pole, T* residual) const {
    const T top =
        coefficients[0] + u * (coefficients[1] + u * (coefficients[2] + u * coefficients[3]));
    residual[0] = top / (u - pole[0]) - depth;
    return true;
  }
};

/// scale * P((h - origin) / scale) as a polynomial in h.
std::array<double, 4> in_hash(const std::array<double, 4>& p, double origin) {
  const double s = kHashScale;
  const double a = p[3] / (s * s);
  const double b = p[2] / s;
  const double c = p[1];
  const double o = origin;
  return {a,
          b - 3 * a * o,
          c - 2 * b * o + 3 * a * o * o,
          s * p[0] - c * o + b * o * o - a * o * o * o};
}

}  // namespace

double ForceCubic::force(double indentation_mm) const noexcept {
  double sum = 0;
  for (const double c : coefficients) sum = sum * indentation_mm + c;
  return sum;
}

double ForceCubic::hash() const noexcept { return force(1); }

ForceCubic fit_cubic(const std::vector<double>& indentations_mm,
                     const std::vector<double>& forces_n) {
  PALP_CHECK(indentations_mm.size() == forces_n.size() && forces_n.size() >= 4, "a cubic's points");
  const auto count = static_cast<Eigen::Index>(forces_n.size());
  Eigen::MatrixXd powers(count, 4);
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double d = indentations_mm[static_cast<std::size_t>(i)];
    powers.row(i) << d * d * d, d * d, d, 1;
    values[i] = forces_n[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd c = least_squares(powers, values);
  return {{c[0], c[1], c[2], c[3]}};
}

double DepthFormula::depth_mm(double hash_n) const noexcept {
  double top = 0;
  for (const double p : numerator) top = top * hash_n + p;
  return top / (hash_n - pole);
}

Result<DepthFormula> fit_formula(const std::vector<double>& hashes_n,
                                 const std::vector<double>& depths_mm,
                                 double plain_hash_n) {
  PALP_CHECK(hashes_n.size() == depths_mm.size() && hashes_n.size() >= 5, "five points at least");
  const double least = *std::min_element(hashes_n.begin(), hashes_n.end());
  if (!(least > plain_hash_n)) {
    return fail("a hash is not above that of the plain block: such an inclusion is not felt");
  }
  std::array<double, 4> coefficients{1, 1, 0, 0};
  double pole = 0;
  ceres::Problem problem;
  for (std::size_t i = 0; i < hashes_n.size(); ++i) {
    auto residual = std::make_unique<DepthResidual>();
    residual->u = (hashes_n[i] - plain_hash_n) / kHashScale;
    residual->depth = depths_mm[i];
    // Ceres takes both over.
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<DepthResidual, 1, 4, 1>(residual.release()),
        nullptr,
        coefficients.data(),
        &pole);
  }
  problem.SetParameterUpperBound(
      &pole, 0, (std::max(plain_hash_n, least - kPoleMargin) - plain_hash_n) / kHashScale);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return fail("eq. (3) cannot be fitted to these hashes");
  return DepthFormula{in_hash(coefficients, plain_hash_n), plain_hash_n + pole * kHashScale};
}

}  // namespace palp::fem
