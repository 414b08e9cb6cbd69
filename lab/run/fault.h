#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/core/time.h"

namespace palp::lab {

/// What goes wrong once, at a chosen moment of the script.
enum class FaultKind : std::uint8_t {
  None,
  KillSurgeon,       ///< the process dies without a word and is started again
  KillPatient,       ///< the same at the patient's site
  StepSurgeonClock,  ///< the clock that the process reads jumps, and stays there
  StepPatientClock,
  PauseSurgeon,  ///< the process stands still, as by SIGSTOP, and goes on; its devices hold
  PausePatient,
  LiftPedal,  ///< the operator lets go and presses again: another epoch
  // Devices that fail and work again.
  SensorSilent,     ///< gives nothing
  SensorStuck,      ///< gives the same reading again and again
  SensorNotFinite,  ///< gives no number
  SensorOffset,     ///< gives 1 N too much
  StageStuck,       ///< stands where it is
  StageFaulted,     ///< says so itself
  HandNotFinite,    ///< the haptic device gives no number
  HandFaulted,      ///< says so itself
  EmergencyStop     ///< pressed at the surgeon's
};

/// Those of devices.
inline constexpr std::array kDeviceFaults{FaultKind::SensorSilent,
                                          FaultKind::SensorStuck,
                                          FaultKind::SensorNotFinite,
                                          FaultKind::SensorOffset,
                                          FaultKind::StageStuck,
                                          FaultKind::StageFaulted,
                                          FaultKind::HandNotFinite,
                                          FaultKind::HandFaulted,
                                          FaultKind::EmergencyStop};

struct Fault {
  FaultKind kind{FaultKind::None};
  Duration at_script_time{};
  /// How long the process is dead or stands still, the pedal up or the device failing; by how much
  /// the clock jumps, of either sign.
  Duration amount{};
  // Of pauses, which may come in bursts.
  std::uint32_t count{1};
  Duration apart{};  ///< from the end of one to the next
};

/// In the order of FaultKind.
inline constexpr std::array<std::string_view, 17> kFaultNames{"none",
                                                              "kill-surgeon",
                                                              "kill-patient",
                                                              "clock-surgeon",
                                                              "clock-patient",
                                                              "pause-surgeon",
                                                              "pause-patient",
                                                              "pedal",
                                                              "sensor-silent",
                                                              "sensor-stuck",
                                                              "sensor-not-finite",
                                                              "sensor-offset",
                                                              "stage-stuck",
                                                              "stage-faulted",
                                                              "hand-not-finite",
                                                              "hand-faulted",
                                                              "emergency-stop"};

[[nodiscard]] constexpr std::string_view to_string(FaultKind kind) noexcept {
  return kFaultNames[static_cast<std::size_t>(kind)];
}

}  // namespace palp::lab
