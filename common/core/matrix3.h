#pragma once

#include <array>
#include <cstddef>

/// Matrices of three rows, small enough to be inverted by the book.
namespace palp {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;

struct Inverse3 {
  Matrix3 matrix{};      ///< [1/unit of what was inverted]
  double determinant{};  ///< [its cube]
};

/// By cofactors. Infinite or NaN if the determinant is zero.
[[nodiscard]] inline Inverse3 inverse(const Matrix3& m) noexcept {
  Inverse3 out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3;
      const std::size_t b = (j + 2) % 3;
      const std::size_t c = (i + 1) % 3;
      const std::size_t d = (i + 2) % 3;
      out.matrix[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  }
  out.determinant =
      m[0][0] * out.matrix[0][0] + m[0][1] * out.matrix[1][0] + m[0][2] * out.matrix[2][0];
  for (Vector3& row : out.matrix) {
    for (double& value : row) value /= out.determinant;
  }
  return out;
}

}  // namespace palp
