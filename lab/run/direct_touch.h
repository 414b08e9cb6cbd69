#pragma once

#include <vector>

#include "lab/run/scenario.h"

namespace palp::lab {

/// A millisecond of a hand that has the tissue under its own finger.
struct TouchTick {
  Duration at{};      ///< since the script began
  double position{};  ///< [m], past the surface
  double force{};     ///< [N]
  Place place;
};

/// The scenario's hand at the scenario's tissue: the same will, grip and handle, no device, no
/// link, no stage. Pure.
[[nodiscard]] std::vector<TouchTick> direct_touch(const Scenario& scenario);

/// The largest force [N] of direct_touch().
[[nodiscard]] double direct_touch_force(const Scenario& scenario);

}  // namespace palp::lab
