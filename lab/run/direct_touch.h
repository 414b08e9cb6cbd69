#pragma once

#include "lab/run/scenario.h"

namespace palp::lab {

/// What the scenario's hand would do if it had the scenario's tissue under its own finger: the same
/// will, grip and handle, no device, no link, no stage. A light hand that taps quickly on something
/// stiff bounces, with any law and with none. Pure.
[[nodiscard]] OwnFinger direct_touch(const Scenario& scenario);

}  // namespace palp::lab
