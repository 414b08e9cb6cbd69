#pragma once

#include <cstdint>
#include <vector>

#include "netem/model/delay_curve.h"
#include "netem/model/impairment.h"
#include "netem/model/normal_draw.h"

namespace palp::netem {

/// An impairment with everything that takes time to compute done: made on an ordinary thread and
/// handed over whole to where decisions are made.
struct PreparedLaw {
  explicit PreparedLaw(const Impairment& asked);

  Impairment impairment;
  DelayCurve curve;
  double carry;  ///< [1], of successive normals for the correlation asked for; 0: none
  DelayCurve slot_curve;
  NormalDraw normal;
  std::vector<std::int16_t> table;       ///< mode netem-6.1: of the delay
  std::vector<std::int16_t> slot_table;  ///< mode netem-6.1: of the slots
};

}  // namespace palp::netem
