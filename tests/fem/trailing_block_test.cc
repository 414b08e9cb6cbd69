#include "fem/trailing_block.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

namespace palp::fem {
namespace {

// Schur's complement is what the last unknowns feel of a matrix.
TEST(TrailingBlockTest, MakesTheStiffnessThatTheLastEquationsFeel) {
  constexpr int kSize = 6;
  constexpr int kLast = 2;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    dense(i, i) = 4 + i;
    if (i > 0) dense(i, i - 1) = dense(i - 1, i) = -1.5;
    if (i > 1) dense(i, i - 2) = dense(i - 2, i) = 0.5;
  }
  const Eigen::SparseMatrix<double> sparse = dense.sparseView();
  using Factor =
      Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const Factor factor{sparse};
  const Eigen::MatrixXd lower = trailing_block(factor.matrixL().nestedExpression(), kLast);
  const Eigen::MatrixXd felt =
      lower * factor.vectorD().tail(kLast).asDiagonal() * lower.transpose();
  const Eigen::MatrixXd schur = dense.bottomRightCorner(kLast, kLast) -
                                dense.bottomLeftCorner(kLast, kSize - kLast) *
                                    dense.topLeftCorner(kSize - kLast, kSize - kLast).inverse() *
                                    dense.topRightCorner(kSize - kLast, kLast);
  EXPECT_LT((felt - schur).norm(), 1e-12);
}

}  // namespace
}  // namespace palp::fem
