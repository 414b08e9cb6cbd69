#include "fem/dense_solver.h"

#include <Eigen/Dense>

namespace palp::fem {

Spectrum spectrum_of(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{symmetric};
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.partialPivLu().solve(right);
}

std::optional<Eigen::VectorXd> solve_symmetric(const Eigen::MatrixXd& matrix,
                                               const Eigen::VectorXd& right) {
  const Eigen::LDLT<Eigen::MatrixXd> factor{matrix};
  if (factor.info() != Eigen::Success) return std::nullopt;
  return factor.solve(right);
}

std::optional<Eigen::VectorXd> solve_positive(const Eigen::MatrixXd& matrix,
                                              const Eigen::VectorXd& right) {
  const Eigen::LLT<Eigen::MatrixXd> factor{matrix};
  if (factor.info() != Eigen::Success) return std::nullopt;
  return factor.solve(right);
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.householderQr().solve(right);
}

}  // namespace palp::fem
