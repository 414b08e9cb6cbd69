#pragma once

#include <vector>

namespace palp::depth {

/// One sample of a stroke as the sensors gave it.
struct TouchSample {
  double tip{};     ///< [m], of the stage, unfiltered
  double force{};   ///< [N], as measured: behind the transducer's pole, in its steps
  double span{};    ///< [s], since the sample before
  bool read{true};  ///< the force is a reading; else it only tells what the pole saw in between
};

/// One stroke, from the air in front of it on.
using Touch = std::vector<TouchSample>;

}  // namespace palp::depth
