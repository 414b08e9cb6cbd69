#pragma once

#include "common/core/time.h"

/// From the units at the border to those inside; the names say both.
namespace palp::settings {

// Divided: powers of ten above one are exact, those below are not.
[[nodiscard]] constexpr double from_milli(double value) noexcept { return value / 1e3; }
[[nodiscard]] constexpr double from_micro(double value) noexcept { return value / 1e6; }

[[nodiscard]] constexpr Duration from_milliseconds(double value) noexcept {
  return from_seconds(value / 1e3);
}
[[nodiscard]] constexpr Duration from_microseconds(double value) noexcept {
  return from_seconds(value / 1e6);
}

}  // namespace palp::settings
