#include "judge/permitted_press.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace palp::judge {

void PermittedPress::begin(const Look& now) {
  most_ = now;
  work_before_ = now.work;
  depths_.clear();
}

void PermittedPress::look(const Look& now) {
  if (now.work >= most_.work) most_ = now;
  if (depths_.empty() || now.position >= depths_.back().position + kDepthStep) {
    depths_.push_back({now.position, now.truth});
  }
}

/// Straight lines between what is kept.
double PermittedPress::truth_kept(double position) const noexcept {
  const auto after = std::ranges::upper_bound(depths_, position, {}, &Depth::position);
  if (after == depths_.begin()) return depths_.front().truth;
  if (after == depths_.end()) return depths_.back().truth;
  const auto before = std::prev(after);
  const double share = (position - before->position) / (after->position - before->position);
  return before->truth + share * (after->truth - before->truth);
}

double PermittedPress::taken(double force, double way, double span) const noexcept {
  const double stored = 0.5 * (force * force - most_.felt * most_.felt) / bound_.grip;
  const double friction = bound_.friction * std::tanh(way / span / bound_.friction_speed);
  return stored + friction * way + bound_.damping * way * way / span;
}

PermittedPress::Permitted PermittedPress::permitted(const Look& held) const noexcept {
  constexpr int kHalvings = 40;
  if (depths_.empty() || !(bound_.grip > 0) || !(bound_.energy >= 0)) {
    return {};
  }
  const double budget = bound_.energy + most_.work - work_before_;  // [J]
  const double span = std::max(kOutLeast, held.at - most_.at);      // [s]
  const auto there = [&](double force) {
    return held.position - (force - held.felt) / bound_.grip;
  };
  double low = std::max(0.0, most_.felt);  // [N]
  double high = std::max(low, most_.truth);
  for (int i = 0; i < kHalvings; ++i) {
    const double force = 0.5 * (low + high);
    const double way = std::max(0.0, most_.position - there(force));
    (taken(force, way, span) <= budget ? low : high) = force;
  }
  // As far as the tissue has relaxed.
  const double relaxed = std::min(1.0, held.truth / truth_kept(held.position));
  return {low, std::min(1.0, low / (relaxed * truth_kept(there(low))))};
}

}  // namespace palp::judge
