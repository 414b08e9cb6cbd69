#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palp::coupling {

/// Finds a hand that swings against a spring by itself: it turns and turns again, faster than by
/// its own will, and no turn is much smaller than the one before. Thread: rt. A value.
class SelfOscillation {
 public:
  /// Once a tick. `position` [m]; `pressed`: against a spring; `passed` [s] since the last one.
  /// @returns whether the hand turned just now, after a swing that did not die out.
  bool step(double position, bool pressed, double passed) noexcept {
    since_ += passed;
    pressed_ = pressed_ || pressed;
    const double side = inwards_ ? 1 : -1;
    if (side * (position - farthest_) >= 0) farthest_ = position;
    if (side * (farthest_ - position) < kPlay) return false;
    const double way = std::abs(farthest_ - turned_);
    const bool swung =
        pressed_ && since_ < kLongest && way > kLeast && way > kDying * std::min(way_, way_before_);
    turned_ = farthest_;
    farthest_ = position;
    inwards_ = !inwards_;
    way_before_ = std::exchange(way_, way);
    since_ = 0;
    pressed_ = pressed;
    count_ = swung ? count_ + 1 : 0;
    return count_ >= kTurns;
  }

 private:
  static constexpr double kPlay = 40e-6;     // [m], a turn by less is the encoder's
  static constexpr double kLeast = 0.12e-3;  // [m], a hand trembles by less
  static constexpr double kLongest = 0.11;   // [s], between turns; no hand taps faster
  static constexpr double kDying = 0.95;     // [-], of the way before
  static constexpr int kTurns = 2;

  double turned_{};                                             ///< [m], where it turned last
  double farthest_{};                                           ///< [m], since then
  double way_{std::numeric_limits<double>::infinity()};         ///< [m], between the last two turns
  double way_before_{std::numeric_limits<double>::infinity()};  ///< [m], between the two before
  double since_{};                                              ///< [s], the last turn
  bool inwards_{true};
  bool pressed_{};
  int count_{};
};

}  // namespace palp::coupling
