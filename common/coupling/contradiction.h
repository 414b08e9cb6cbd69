#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::coupling {

/// How much a peer takes back of what it told. Who learns a tissue tells more and more of it, or
/// less and less; who raises a force and lowers it again, without a motion of the hand, does not
/// know it or lies. Thread: rt. A value.
class Contradiction {
 public:
  /// News changed the told force at the hand's own place by `change` [N].
  void tell(double change) noexcept {
    told_ += change;
    const double edge = std::clamp(followed_, told_ - kPlay, told_ + kPlay);
    const double moved = edge - std::exchange(followed_, edge);
    (moved > 0 ? raised_ : lowered_) += std::abs(moved);
  }
  /// `passed` [s] without any.
  void age(double passed) noexcept {
    const double kept = std::exp(-passed / kMemory);
    raised_ *= kept;
    lowered_ *= kept;
  }
  /// [N], that was raised and lowered again, or the other way round, in the last kMemory.
  [[nodiscard]] double taken_back() const noexcept { return std::min(raised_, lowered_); }

 private:
  static constexpr double kPlay = 0.03;  // [N], to either side: what noise does to a model
  static constexpr double kMemory = 10;  // [s]

  double told_{};      ///< [N], all changes
  double followed_{};  ///< [N], the same with play
  double raised_{};    ///< [N]
  double lowered_{};   ///< [N]
};

}  // namespace palp::coupling
