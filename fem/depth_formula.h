#pragma once

#include <array>
#include <vector>

#include "common/core/result.h"

/// The paper's way from a force curve to a depth, in its own units: millimetre and newton.
namespace palp::fem {

/// Paper eq. (2): f = c1 d^3 + c2 d^2 + c3 d + c4.
struct ForceCubic {
  std::array<double, 4> coefficients{};  ///< [N/mm^3, N/mm^2, N/mm, N]
  [[nodiscard]] double force(double indentation_mm) const noexcept;
  /// The hash h, the sum of the coefficients: the force at 1 mm. [N]
  [[nodiscard]] double hash() const noexcept;
};

/// Least squares; at least four points.
[[nodiscard]] ForceCubic fit_cubic(const std::vector<double>& indentations_mm,
                                   const std::vector<double>& forces_n);

/// Paper eq. (3): depth = (p1 h^3 + p2 h^2 + p3 h + p4) / (h - q).
struct DepthFormula {
  std::array<double, 4> numerator{};  ///< [mm N^(1-k)], of h^3 first
  double pole{};                      ///< [N], the hash of the plain block: infinite depth
  [[nodiscard]] double depth_mm(double hash_n) const noexcept;
};

/// As printed in the paper.
inline constexpr DepthFormula kPaperFormula{{9008, -2124, 168.5, -4.372}, 0.05914};

/// All five coefficients by least squares of the depth; the pole starts at `plain_hash_n` and stays
/// below every hash. At least five points.
[[nodiscard]] Result<DepthFormula> fit_formula(const std::vector<double>& hashes_n,
                                               const std::vector<double>& depths_mm,
                                               double plain_hash_n);

}  // namespace palp::fem
