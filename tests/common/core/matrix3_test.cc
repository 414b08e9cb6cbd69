// Goal: the inverse of a small matrix is one. Method: products with what was inverted.
#include "common/core/matrix3.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(Matrix3Test, AMatrixTimesItsInverseIsOne) {
  const Matrix3 matrix{{{4, 1, -2}, {0.5, 3, 7}, {-1, 2, 5}}};
  const Inverse3 inverted = inverse(matrix);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += matrix[i][k] * inverted.matrix[k][j];
      EXPECT_NEAR(sum, i == j ? 1 : 0, 1e-14);
    }
  }
}

TEST(Matrix3Test, TheDeterminantIsTheVolume) {
  EXPECT_DOUBLE_EQ(inverse(Matrix3{{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}}).determinant, 24);
  EXPECT_DOUBLE_EQ(inverse(Matrix3{{{0, 3, 0}, {2, 0, 0}, {0, 0, 4}}}).determinant, -24);
}

}  // namespace
}  // namespace palp
