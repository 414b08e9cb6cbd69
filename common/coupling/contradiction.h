#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::coupling {

/// How much a peer takes back of what it told: of a force [N], or of where a surface is [m]. Who
/// learns a tissue tells more and more of it, or less and less; who raises a force and lowers it
/// again, without a motion of the hand, does not know it or lies. Thread: rt. A value.
class Contradiction {
 public:
  /// To either side, what noise does to a model.
  explicit Contradiction(double play) noexcept : play_{play} {}
  /// News changed by `change` what is told of the hand's own place.
  void tell(double change) noexcept {
    told_ += change;
    const double edge = std::clamp(followed_, told_ - play_, told_ + play_);
    const double moved = edge - std::exchange(followed_, edge);
    (moved > 0 ? raised_ : lowered_) += std::abs(moved);
  }
  /// `passed` [s] without any.
  void age(double passed) noexcept {
    const double kept = std::exp(-passed / kMemory);
    raised_ *= kept;
    lowered_ *= kept;
  }
  /// What was raised and lowered again, or the other way round, in the last kMemory.
  [[nodiscard]] double taken_back() const noexcept { return std::min(raised_, lowered_); }
  /// [-] >= 1, how many times slower its peer is to be followed: more than `believed` is doubted,
  /// with the square of the rest over `doubt`.
  [[nodiscard]] double slower(double believed, double doubt) const noexcept {
    const double doubts = std::max(0.0, taken_back() - believed) / doubt;
    return 1 + doubts * doubts;
  }

 private:
  static constexpr double kMemory = 10;  // [s]

  double play_;        ///< [N] or [m]
  double told_{};      ///< [N] or [m], all changes
  double followed_{};  ///< [N] or [m], the same with play
  double raised_{};    ///< [N] or [m]
  double lowered_{};   ///< [N] or [m]
};

}  // namespace palp::coupling
