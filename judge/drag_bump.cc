#include "judge/drag_bump.h"

#include <algorithm>

namespace palp::judge {

void DragBump::add(Rise& rise, const Force& now) {
  if (rise.empty() || now.force >= rise.back().force + kForceStep) rise.push_back(now);
}

void DragBump::look(double at, bool dragging, double felt, double touched) {
  if (over_ || !(begun_ || dragging)) return;
  begun_ = true;
  if (dragging) dragged_at_ = at;
  over_ = touched < kContact || at > dragged_at_ + kAfter;
  if (over_) return;
  add(felt_, {at, felt});
  add(touched_, {at, touched});
}

bool DragBump::bumped() const noexcept {
  return !touched_.empty() && touched_.back().force >= touched_.front().force + kBumpLeast;
}

double DragBump::error() const noexcept {
  if (!bumped()) return std::numeric_limits<double>::quiet_NaN();
  return felt_.back().force / touched_.back().force - 1;
}

double DragBump::felt() const noexcept {
  return bumped() ? felt_.back().force : std::numeric_limits<double>::quiet_NaN();
}

double DragBump::half_way(const Rise& rise) noexcept {
  const double half = 0.5 * (rise.front().force + rise.back().force);
  return std::find_if(
             rise.begin(), rise.end(), [half](const Force& one) { return one.force >= half; })
      ->at;
}

double DragBump::shift() const noexcept {
  if (!bumped()) return std::numeric_limits<double>::quiet_NaN();
  return half_way(felt_) - half_way(touched_);
}

}  // namespace palp::judge
