#include "study/closed_loop/felt_slopes.h"

#include <algorithm>
#include <cmath>

#include "common/core/line_fit.h"

namespace palp::study {

void FeltSlopes::turn() {
  LineFit line;
  double most = 0;
  way_in_.resize(deepest_at_);  // what came after is the way out
  for (const Tick& tick : way_in_) {
    const double before = deepest_ - tick.position;
    most = std::max(most, tick.force);
    if (before >= kTo && before <= kFrom) line.add(tick.position, tick.force);
  }
  way_in_.clear();
  if (most < kContact || line.count() < kTicksMin) return;
  const double slope = line.slope();
  if (std::isfinite(slope) && slope > 0) ln_slopes_.push_back(std::log(slope));
}

void FeltSlopes::feel(double position, double force) {
  if (!begun_) {
    begun_ = true;
    deepest_ = highest_ = position;
  }
  if (going_in_) {
    way_in_.push_back({position, force});
    if (position >= deepest_) {
      deepest_ = position;
      deepest_at_ = way_in_.size();
    }
    if (position < deepest_ - kTurned) {
      turn();
      going_in_ = false;
      highest_ = position;
    }
    return;
  }
  highest_ = std::min(highest_, position);
  if (position > highest_ + kTurned) {
    going_in_ = true;
    deepest_ = position;
    way_in_.assign(1, {position, force});
    deepest_at_ = 1;
  }
}

}  // namespace palp::study
