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

/// What the lab compares with of it: its largest force and how far it swings. A light hand that
/// taps quickly on something stiff bounces, with any law and with none.
[[nodiscard]] OwnFinger own_finger(const Scenario& scenario);

}  // namespace palp::lab
