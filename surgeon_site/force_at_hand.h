#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/core/device_facts.h"

namespace palp::surgeon {

/// The force that worked at the hand while it moved as the newest reading says. At a device of 1
/// kHz that is the force of the last tick. At a slower one, or one that lags, it is an older one,
/// and nobody knows which: then it is the least of those that it may have been where the hand moved
/// in, and the greatest where it moved out. So no account believes that a hand gave what it did not
/// give. Lags and periods count up to 200 ms. Thread: rt. A value.
class ForceAtHand {
 public:
  /// `period` [s], of the control loop.
  ForceAtHand(const HandFacts& hand, double period) noexcept
      : newest_back_{ticks(hand.lag, period)},
        oldest_back_{ticks(hand.lag + 2 * std::max(0.0, 1 / hand.rate - period), period)} {}

  /// `force` [N], given `count` ticks long.
  void give(double force, std::int64_t count) noexcept {
    const auto most = static_cast<std::int64_t>(given_.size());
    for (std::int64_t i = 0; i < std::min(count, most); ++i) {
      newest_ = (newest_ + 1) % given_.size();
      given_[newest_] = force;
    }
  }
  /// [N], while the hand went `way` [m].
  [[nodiscard]] double over(double way) const noexcept {
    double force = back(newest_back_);
    for (std::size_t i = newest_back_ + 1; i <= oldest_back_; ++i) {
      force = way > 0 ? std::min(force, back(i)) : std::max(force, back(i));
    }
    return force;
  }

 private:
  static constexpr double kMost = 200;  // [-], ticks

  [[nodiscard]] static std::size_t ticks(double span, double period) noexcept {
    return static_cast<std::size_t>(std::clamp(std::round(span / period), 0.0, kMost));
  }
  [[nodiscard]] double back(std::size_t ticks) const noexcept {
    return given_[(newest_ + given_.size() - ticks) % given_.size()];
  }

  std::size_t newest_back_;
  std::size_t oldest_back_;
  std::size_t newest_{};
  std::array<double, 256> given_{};  ///< [N]
};

}  // namespace palp::surgeon
