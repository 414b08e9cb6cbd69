#pragma once

#include <algorithm>

namespace palp::judge {

/// How far and how long the tip's force stays beyond the limit from which the gate retreats.
/// Thread: any one.
class TipGuard {
 public:
  static constexpr double kBeyond = 0.1;  ///< [N], that counts as time

  explicit TipGuard(double limit) : limit_{limit} {}  ///< [N]

  /// In order of time: `at` [s], `force` [N] of the tip.
  void look(double at, double force) noexcept {
    excess_ = std::max(excess_, force - limit_);
    const bool beyond = force > limit_ + kBeyond;
    if (beyond && !beyond_) began_at_ = at;
    beyond_ = beyond;
    if (beyond) longest_ = std::max(longest_, at - began_at_);
  }
  [[nodiscard]] double excess() const noexcept { return excess_; }    ///< [N], most; >= 0
  [[nodiscard]] double longest() const noexcept { return longest_; }  ///< [s], on end

 private:
  double limit_;  ///< [N]
  bool beyond_{};
  double began_at_{};  ///< [s]
  double excess_{};    ///< [N]
  double longest_{};   ///< [s]
};

}  // namespace palp::judge
