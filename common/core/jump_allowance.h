#pragma once

#include <algorithm>
#include <cmath>

namespace palp {

/// Tells readings of a place that no motion leads to from late stamps and rounding: beyond its
/// speed a place may jump by so much, and again only slowly, so that one who jumps to and fro by
/// less each time is found too. A value.
class JumpAllowance {
 public:
  /// `speed` [m/s], which nothing that is read exceeds.
  explicit JumpAllowance(double speed) noexcept : speed_{speed} {}

  void reset() noexcept { left_ = kFree; }
  /// @returns whether `way` [m] in `span` [s] is a jump.
  [[nodiscard]] bool jumped(double way, double span) noexcept {
    const double excess = std::abs(way) - speed_ * std::max(0.0, span);
    left_ = std::min(kFree, left_ + kFree / kAgainAfter * std::max(0.0, span));
    if (excess > 0) left_ -= excess;
    return left_ < 0;
  }

 private:
  static constexpr double kFree = 2e-3;       // [m], more than any rounding or late stamp
  static constexpr double kAgainAfter = 0.5;  // [s]

  double speed_;        ///< [m/s]
  double left_{kFree};  ///< [m]
};

}  // namespace palp
