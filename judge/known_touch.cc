#include "judge/known_touch.h"

#include <cmath>
#include <limits>
#include <utility>

namespace palp::judge {

void KnownTouch::look(double at, double tip, double contact_force) {
  if (contact_force < kContact) return;
  if (depths_.empty() || tip >= depths_.back().tip + kDepthStep) depths_.push_back({at, tip});
}

/// [m], how deep the tip had been by `at` [s]; -infinity: it had touched nothing.
double KnownTouch::touched_by(double at) const noexcept {
  double deepest = -std::numeric_limits<double>::infinity();
  for (const Depth& depth : depths_) {
    if (depth.at <= at) deepest = depth.tip;
  }
  return deepest;
}

void KnownTouch::tap(const TapMetrics& tap) {
  const FeltStiffness& stiffness = tap.stiffness;
  if (!stiffness.error() || !(*stiffness.truth() <= config_.stiffest)) return;
  if (!(stiffness.truth_most() < kSaturated * config_.force_continuous)) return;
  if (!(stiffness.deviation() >= kTapSpread)) return;
  const double known = touched_by(tap.began_at - config_.round_trip - kTapAfter);
  if (!(stiffness.deepest() <= known + kBeyond)) return;
  tap_felt_ += stiffness.spread() * *stiffness.felt();
  tap_truth_ += stiffness.spread() * *stiffness.truth();
}

void KnownTouch::feel(const PermittedPress::Look& hand) {
  const bool presses = hand.truth >= kContact;
  if (presses && !std::exchange(pressed_, presses)) press_.begin(hand);
  pressed_ = presses;
  if (presses) press_.look(hand);
}

void KnownTouch::hold(const Hold& hold) noexcept {
  if (std::isinf(touched_by(hold.from - config_.round_trip - kHoldAfter))) return;
  const bool saturated = !(hold.felt < kSaturated * config_.force_continuous);
  if (!(hold.truth >= kHeldLeast) || saturated) return;
  // No curve that is nowhere steeper than may be shown reaches this force.
  if (hold.truth > config_.stiffest * hold.position) return;
  const PermittedPress::Look held{
      .at = hold.until, .felt = hold.felt, .truth = hold.truth, .position = hold.position};
  if (press_.permitted(held).share < PermittedPress::kAll) return;
  held_off_ += std::abs(hold.felt - hold.truth);
  held_truth_ += hold.truth;
}

double KnownTouch::tap_error() const noexcept {
  return tap_truth_ > 0 ? tap_felt_ / tap_truth_ - 1 : kUndefined;
}

double KnownTouch::held_error() const noexcept {
  return held_truth_ > 0 ? held_off_ / held_truth_ : kUndefined;
}

}  // namespace palp::judge
