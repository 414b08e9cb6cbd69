#pragma once

#include "common/core/place.h"
#include "common/core/time.h"

namespace palp::judge {

/// One tick of a hand or a tip.
struct Motion {
  TimePoint at{};
  double position{};  ///< [m], hand or tip
  double velocity{};  ///< [m/s]
  double force{};     ///< [N], surgeon: applied to the hand, patient: contact
  Place place;
};

}  // namespace palp::judge
