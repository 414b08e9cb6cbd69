// Goal: what is solved solves its system; what cannot be solved is said. Method: random systems.
#include "fem/dense_solver.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "common/core/random.h"

namespace palp::fem {
namespace {

Eigen::MatrixXd some_matrix(int rows, int columns, std::uint64_t seed) {
  Eigen::MatrixXd out(rows, columns);
  std::uint64_t number = 0;
  for (double& value : out.reshaped()) value = 2 * random_uniform(seed, 0, number++) - 1;
  return out;
}

/// Positive definite: its least value is 1.
Eigen::MatrixXd some_positive(int size, std::uint64_t seed) {
  const Eigen::MatrixXd root = some_matrix(size, size, seed);
  return root * root.transpose() + Eigen::MatrixXd::Identity(size, size);
}

RC_GTEST_PROP(DenseSolverTest, SolutionsSolveTheirSystems, (std::uint64_t seed)) {
  const int size = 1 + static_cast<int>(seed % 12);
  const Eigen::MatrixXd matrix = some_positive(size, seed);
  const Eigen::VectorXd right = some_matrix(size, 1, seed + 1);
  const auto positive = solve_positive(matrix, right);
  const auto symmetric = solve_symmetric(-matrix, right);
  RC_ASSERT(positive && symmetric);
  RC_ASSERT((matrix * *positive - right).norm() < 1e-11);
  RC_ASSERT((matrix * *symmetric + right).norm() < 1e-11);
  RC_ASSERT((matrix * solve(matrix, right) - right).norm() < 1e-11);
  RC_ASSERT(!solve_positive(-matrix, right));
}

RC_GTEST_PROP(DenseSolverTest, ASpectrumMakesItsMatrix, (std::uint64_t seed)) {
  const int size = 1 + static_cast<int>(seed % 12);
  const Eigen::MatrixXd matrix = some_positive(size, seed);
  const Spectrum found = spectrum_of(matrix);
  const Eigen::MatrixXd again =
      found.vectors * found.values.asDiagonal() * found.vectors.transpose();
  RC_ASSERT((again - matrix).norm() < 1e-11 * matrix.norm());
  for (int i = 1; i < size; ++i) RC_ASSERT(found.values[i] >= found.values[i - 1]);
}

RC_GTEST_PROP(DenseSolverTest, WhatALeastFitLeavesIsNormalToItsColumns, (std::uint64_t seed)) {
  const Eigen::MatrixXd matrix = some_matrix(12, 4, seed);
  const Eigen::VectorXd right = some_matrix(12, 1, seed + 1);
  const Eigen::VectorXd left = right - matrix * least_squares(matrix, right);
  RC_ASSERT((matrix.transpose() * left).norm() < 1e-11);
}

}  // namespace
}  // namespace palp::fem
