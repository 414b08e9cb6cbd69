#include "judge/known_touch.h"

#include <cmath>

namespace palp::judge {

void KnownTouch::look(double at, double tip, double contact_force) {
  if (contact_force < kContact) return;
  if (depths_.empty() || tip >= depths_.back().tip + kDepthStep) depths_.push_back({at, tip});
}

/// [m], how deep the tip had been by `at` [s]; -infinity: it had touched nothing.
double KnownTouch::touched_by(double at) const noexcept {
  double deepest = -INFINITY;
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

void KnownTouch::hold(double from, double felt, double truth) noexcept {
  if (std::isinf(touched_by(from - config_.round_trip - kHoldAfter))) return;
  if (!(truth >= kHeldLeast) || !(felt < kSaturated * config_.force_continuous)) return;
  held_off_ += std::abs(felt - truth);
  held_truth_ += truth;
}

double KnownTouch::tap_error() const noexcept {
  return tap_truth_ > 0 ? tap_felt_ / tap_truth_ - 1 : kUndefined;
}

double KnownTouch::held_error() const noexcept {
  return held_truth_ > 0 ? held_off_ / held_truth_ : kUndefined;
}

}  // namespace palp::judge
