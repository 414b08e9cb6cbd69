#pragma once

#include "lab/run/scenario.h"

namespace palp::lab {

/// The largest force [N] with which the scenario's hand would press the scenario's tissue if it had
/// it under its own finger: the same will, grip and handle, no device, no link, no stage. Pure.
[[nodiscard]] double direct_touch_force(const Scenario& scenario);

}  // namespace palp::lab
