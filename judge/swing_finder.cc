#include "judge/swing_finder.h"

#include <algorithm>
#include <cmath>

namespace palp::judge {

void SwingFinder::restart() noexcept {
  begun_ = false;
  direction_ = 0;
  count_ = 0;
}

void SwingFinder::look(const Look& now) noexcept {
  const auto go_on = [&] {
    extreme_ = now.position;
    extreme_at_ = now.at;
    extreme_given_ = now.given;
  };
  if (!begun_) {
    begun_ = true;
    go_on();
    turned_ = now.position;
    turned_at_ = now.at;
    return;
  }
  if (direction_ == 0) {
    if (std::abs(now.position - turned_) < kHysteresis) return;
    direction_ = now.position > turned_ ? 1 : -1;
    go_on();
  } else if (direction_ * (now.position - extreme_) >= 0) {
    go_on();
  } else if (direction_ * (extreme_ - now.position) >= kHysteresis) {
    turn();
    direction_ = -direction_;
    go_on();
  }
}

void SwingFinder::turn() noexcept {
  const double half = extreme_at_ - turned_at_;  // [s], of a period
  const Swing swing{std::abs(extreme_ - turned_), extreme_given_};
  turned_ = extreme_;
  turned_at_ = extreme_at_;
  if (half > 0.5 / slowest_ || half < 0.5 / kQuickest) {
    count_ = 0;
    return;
  }
  swings_[count_++ % kTurns] = swing;
  if (count_ >= kTurns && fed()) {
    largest_ = std::max(largest_, std::ranges::min(swings_, {}, &Swing::size).size);
  }
}

/// Over the last kTurns swings.
bool SwingFinder::fed() const noexcept {
  if (std::isnan(extreme_given_)) return true;
  const auto most = [&](std::size_t first) {
    double given = -std::numeric_limits<double>::infinity();  // [J]
    for (std::size_t i = first; i < first + kEven; ++i) {
      given = std::max(given, swings_[i % kTurns].given);
    }
    return given;
  };
  return most(count_ + kTurns - kEven) > most(count_);
}

}  // namespace palp::judge
