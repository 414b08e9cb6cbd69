#pragma once

#include <optional>

#include "common/core/time.h"

namespace palp::io {

/// The world's time as the system has it.
struct WallClockReading {
  Duration ahead{};                       ///< nanoseconds since 1970 in UTC - SteadyClock
  Duration zone{};                        ///< local time - UTC
  bool synchronised{};                    ///< something keeps the system's clock right
  std::optional<Duration> uncertainty{};  ///< as the system estimates it; absent: it cannot
};

/// Reads the realtime clock between two readings of the steady one, a few times, and takes the
/// tightest. Not for rt.
[[nodiscard]] WallClockReading read_wall_clock() noexcept;

}  // namespace palp::io
