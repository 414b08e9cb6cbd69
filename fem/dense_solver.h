#pragma once

#include <optional>

#include <Eigen/Core>

/// Eigen's dense factorizations, each instantiated in one source: they take a compiler longer than
/// all else in this room. Thread: any; each call allocates.
namespace palp::fem {

struct Spectrum {
  Eigen::VectorXd values;   ///< ascending
  Eigen::MatrixXd vectors;  ///< columns, of unit length
};
/// Of a symmetric matrix; only its lower triangle is read.
[[nodiscard]] Spectrum spectrum_of(const Eigen::MatrixXd& symmetric);

/// X of matrix * X = right; the matrix is square and regular.
[[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// x of matrix * x = right; the matrix is symmetric. nullopt: it is singular.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_symmetric(const Eigen::MatrixXd& matrix,
                                                             const Eigen::VectorXd& right);

/// The same where the matrix is positive definite. nullopt: it is not.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_positive(const Eigen::MatrixXd& matrix,
                                                            const Eigen::VectorXd& right);

/// x that makes |matrix * x - right| least; no fewer rows than columns.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix,
                                            const Eigen::VectorXd& right);

}  // namespace palp::fem
