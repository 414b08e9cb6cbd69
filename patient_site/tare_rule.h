#pragma once

#include <optional>
#include <string_view>

#include "patient_site/patient_status.h"

namespace palp::patient {

/// Why a force sensor may not be tared now; nullopt: it may. Asked when a person wants a tare, and
/// at each tick, which ends one that is under way. The sensor itself cannot tell a light
/// touch from a zero that drifted: the place of the tip can.
[[nodiscard]] inline std::optional<std::string_view> why_no_tare(
    const PatientStatus& status) noexcept {
  constexpr double kClear = 3e-3;  // [m], above the surface
  if (status.state == SiteState::Engaged) return "the site is engaged";
  const double surface = status.surface_known ? status.surface : 0;
  if (status.position > surface - kClear) {
    return "the tip is not 3 mm clear of the surface";
  }
  return std::nullopt;
}

}  // namespace palp::patient
