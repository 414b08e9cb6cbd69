#include "judge/first_press.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace palp::judge {

void FirstPress::look(const Look& now) {
  if (over_) return;
  if (now.truth < kContact) {
    over_ = begun_;
    return;
  }
  if (!std::exchange(begun_, true)) {
    began_at_ = now.at;
    most_ = now;
  }
  if (now.work >= most_.work) most_ = now;
  if (depths_.empty() || now.position >= depths_.back().position + kDepthStep) {
    depths_.push_back({now.position, now.truth});
  }
  const double since = now.at - began_at_;
  if (since < kSettled) return;
  felt_ += now.felt;
  truth_ += now.truth;
  over_ = settled_ = since >= kSettled + kWindow;
}

double FirstPress::share() const noexcept {
  return settled_ ? felt_ / truth_ : std::numeric_limits<double>::quiet_NaN();
}

/// Straight lines between what is kept.
double FirstPress::truth_at(double position) const noexcept {
  const auto after = std::ranges::upper_bound(depths_, position, {}, &Depth::position);
  if (after == depths_.begin()) return depths_.front().truth;
  if (after == depths_.end()) return depths_.back().truth;
  const auto before = std::prev(after);
  const double share = (position - before->position) / (after->position - before->position);
  return before->truth + share * (after->truth - before->truth);
}

double FirstPress::permitted() const noexcept {
  constexpr int kHalvings = 40;
  if (!settled_ || !(bound_.grip > 0) || !(bound_.energy >= 0)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double budget = bound_.energy + most_.work;  // [J]
  const auto there = [this](double force) {
    return most_.position - (force - most_.felt) / bound_.grip;
  };
  double low = std::max(0.0, most_.felt);  // [N]
  double high = std::max(low, most_.truth);
  for (int i = 0; i < kHalvings; ++i) {
    const double force = 0.5 * (low + high);
    const double taken = 0.5 * (force * force - most_.felt * most_.felt) / bound_.grip;
    (taken <= budget ? low : high) = force;
  }
  return std::min(1.0, low / truth_at(there(low)));
}

}  // namespace palp::judge
