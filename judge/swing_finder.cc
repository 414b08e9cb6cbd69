#include "judge/swing_finder.h"

#include <algorithm>
#include <cmath>

namespace palp::judge {

void SwingFinder::restart() noexcept {
  begun_ = false;
  direction_ = 0;
  count_ = 0;
}

void SwingFinder::look(double at, double position) noexcept {
  if (!begun_) {
    begun_ = true;
    extreme_ = turned_ = position;
    extreme_at_ = turned_at_ = at;
    return;
  }
  if (direction_ == 0) {
    if (std::abs(position - turned_) < kHysteresis) return;
    direction_ = position > turned_ ? 1 : -1;
    extreme_ = position;
    extreme_at_ = at;
  } else if (direction_ * (position - extreme_) >= 0) {
    extreme_ = position;
    extreme_at_ = at;
  } else if (direction_ * (extreme_ - position) >= kHysteresis) {
    turn();
    direction_ = -direction_;
    extreme_ = position;
    extreme_at_ = at;
  }
}

void SwingFinder::turn() noexcept {
  const double half = extreme_at_ - turned_at_;  // [s], of a period
  const double swing = std::abs(extreme_ - turned_);
  turned_ = extreme_;
  turned_at_ = extreme_at_;
  if (half > 0.5 / kSlowest || half < 0.5 / kQuickest) {
    count_ = 0;
    return;
  }
  swings_[count_++ % kTurns] = swing;
  if (count_ >= kTurns) largest_ = std::max(largest_, *std::ranges::min_element(swings_));
}

}  // namespace palp::judge
