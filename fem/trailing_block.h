#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace palp::fem {

/// The last `size` rows and columns of a sparse unit lower triangle, dense. Where the factors
/// L D L^T of a stiffness matrix have the surface's equations last, this block with its part of D
/// makes the stiffness as the surface feels it, everything else eliminated. Thread: any.
[[nodiscard]] inline Eigen::MatrixXd trailing_block(const Eigen::SparseMatrix<double>& lower,
                                                    int size) {
  const int first = static_cast<int>(lower.cols()) - size;
  Eigen::MatrixXd block = Eigen::MatrixXd::Identity(size, size);
  for (int column = 0; column < size; ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it{lower, first + column}; it; ++it) {
      if (it.row() > it.col()) block(it.row() - first, column) = it.value();
    }
  }
  return block;
}

}  // namespace palp::fem
