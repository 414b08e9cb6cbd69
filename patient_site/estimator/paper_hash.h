#pragma once

#include "common/message/depth.h"
#include "patient_site/estimator/cubic_fit.h"

namespace palp::estimator {

/// The paper's h = c1 + c2 + c3 + c4 of eq. (2): the cubic at 1 mm. [N]
[[nodiscard]] double hash(const Cubic& cubic) noexcept;

/// Eq. (3) with the paper's coefficients, wherever it is defined: h [N] -> depth [m].
[[nodiscard]] double depth_of_hash(double hash) noexcept;

struct HashVerdict {
  DepthVerdict verdict{};
  DepthReason reason{};
  double depth{};  ///< [m]; 0 unless Found
};

/// What h says. Eq. (3) has a pole at h = 0.0591 N and its minimum, 5.04 mm, near h = 0.090 N:
/// below 0.0609 N (its value for 25 mm, the deepest inclusion it was fitted to) there is no
/// inclusion in reach, and above 0.095 N it would call stiffer tissue a deeper inclusion.
[[nodiscard]] HashVerdict judge_hash(double hash) noexcept;

inline constexpr double kHashMin = 0.0609;  ///< [N], eq. (3) holds from here
inline constexpr double kHashMax = 0.095;   ///< [N], to here

}  // namespace palp::estimator
