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
  LiftPedal  ///< the operator lets go and presses again: another epoch
};

struct Fault {
  FaultKind kind{FaultKind::None};
  Duration at_script_time{};
  /// How long the process is dead or the pedal up; by how much the clock jumps, of either sign.
  Duration amount{};
};

[[nodiscard]] constexpr std::string_view to_string(FaultKind kind) noexcept {
  constexpr std::array<std::string_view, 6> kNames{
      "none", "kill-surgeon", "kill-patient", "clock-surgeon", "clock-patient", "pedal"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace palp::lab
