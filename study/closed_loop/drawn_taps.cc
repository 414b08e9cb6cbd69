#include "study/closed_loop/drawn_taps.h"

#include <algorithm>
#include <cmath>

namespace palp::study {

void DrawnTaps::see(double position, double force) {
  deepest_ = std::max(deepest_, position);
  if (force > kContact) {
    most_ = std::max(most_, force);
    return;
  }
  const double read = step_ > 0 ? step_ * std::round(most_ / step_) : most_;
  if (read > 0 && deepest_ > 0) ln_stiffness_.push_back(std::log(read / deepest_));
  if (most_ > 0) deepest_ = 0;
  most_ = 0;
}

}  // namespace palp::study
