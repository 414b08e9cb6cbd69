#pragma once

#include "lab/plan/plan.h"

/// The sets whose cases are drawn: case i from (seed, i) alone.
namespace palp::lab {

/// Links, hands, servos and inclusions at random; `hard`: to 2 s, 20 % loss, bursts of 1 s.
void fill_random(Plan& plan, const PlanAsk& ask, bool hard);

// Each of these over the links and hands of the above.
void fill_faults(Plan& plan, const PlanAsk& ask);         ///< of a process, a clock, the pedal
void fill_device_faults(Plan& plan, const PlanAsk& ask);  ///< of sensor, stage, haptic device
void fill_pauses(Plan& plan, const PlanAsk& ask);         ///< of a process; every other peer lies
void fill_devices(Plan& plan, const PlanAsk& ask);        ///< paces, lags and steps of devices
void fill_wild(Plan& plan, const PlanAsk& ask);           ///< tissues and gestures
void fill_first(Plan& plan, const PlanAsk& ask);          ///< first presses that are held

}  // namespace palp::lab
