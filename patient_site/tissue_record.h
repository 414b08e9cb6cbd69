#pragma once

#include "common/record/session_writer.h"
#include "patient_site/motion_gate.h"
#include "patient_site/phantom.h"

namespace palp::patient {

/// The truth about the tissue, into a session file, for whoever judges the session afterwards.
/// `surface_offset` [m]. Of `gate` what the tissue's tables left of the settings' travel: who does
/// the session again needs it.
void describe_tissue(const Phantom& phantom,
                     double surface_offset,
                     const MotionGateConfig& gate,
                     record::SessionInfo& info);

/// Of the metadata: MotionGateConfig::travel_max as it was [m].
inline constexpr const char* kTravelMaxKey = "gate_travel_max_m";
/// Of the metadata: PatientConfig::sensor_stale as the devices' file made it [ns].
inline constexpr const char* kSensorStaleKey = "sensor_stale_ns";

}  // namespace palp::patient
