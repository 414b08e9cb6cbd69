#pragma once

#include <cstdint>
#include <string>

#include "common/core/time.h"

namespace palp::record {

/// Where a site's own line of time lies in the world's. A session's files take one and keep it, so
/// that a step of the system's clock bends no curve.
struct WallClock {
  Duration ahead{};                     ///< nanoseconds since 1970 in UTC - own time
  std::string source{"none"};           ///< realtime, virtual; none: stamps are the own time
  std::string zone{"UTC"};              ///< the site's, as offset: +01:00
  std::string synchronised{"unknown"};  ///< yes, no, unknown
  std::string uncertainty_us{};         ///< as the system estimates it [us]; empty: unknown

  [[nodiscard]] std::uint64_t stamp(TimePoint at) const noexcept {
    return static_cast<std::uint64_t>(at.time_since_epoch().count()) +
           static_cast<std::uint64_t>(ahead.count());
  }
  [[nodiscard]] TimePoint own(std::uint64_t stamp) const noexcept {
    return TimePoint{
        Duration{static_cast<std::int64_t>(stamp - static_cast<std::uint64_t>(ahead.count()))}};
  }
};

/// Of the metadata record `palp`: WallClock::ahead [ns].
inline constexpr const char* kWallClockKey = "wall_clock_minus_own_ns";

/// A session's id as people and files have it: 16 hexadecimal digits.
[[nodiscard]] std::string session_id_text(std::uint64_t session_id);

/// "2026-11-23T03:01:02.123456789Z" of nanoseconds since 1970 in UTC.
[[nodiscard]] std::string utc_text(std::uint64_t stamp);

}  // namespace palp::record
