#include "study/closed_loop/felt_slopes.h"

#include <algorithm>
#include <cmath>

#include "common/core/line_fit.h"

namespace palp::study {

void FeltSlopes::turn() {
  LineFit line;
  double most = 0;
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
    deepest_ = std::max(deepest_, position);
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
  }
}

}  // namespace palp::study
