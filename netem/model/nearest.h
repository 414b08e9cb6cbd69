#pragma once

#include <cstdint>

#include "common/core/time.h"

namespace palp::netem {

/// The nearest duration to so many nanoseconds, which are not negative.
[[nodiscard]] inline Duration nearest(double nanoseconds) noexcept {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): right from 0 on, and lround would be a call
  return Duration{static_cast<std::int64_t>(nanoseconds + 0.5)};
}

}  // namespace palp::netem
