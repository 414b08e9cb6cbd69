#pragma once

#include <chrono>
#include <cstdint>

namespace palp {

/// The time line of this process: nanoseconds since an arbitrary start, never wall time.
/// No now() on purpose: the control core is told the time, it cannot ask.
struct HouseTime {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<HouseTime>;
  static constexpr bool is_steady = true;  // NOLINT(readability-identifier-naming): std
};

/// The other site's line. Another type: subtracting one from the other does not compile.
struct PeerTime {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<PeerTime>;
  static constexpr bool is_steady = true;  // NOLINT(readability-identifier-naming): std
};

using Duration = HouseTime::duration;
using TimePoint = HouseTime::time_point;
using PeerTimePoint = PeerTime::time_point;

/// Asked only by io and lab::World; everything else is given `now`.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual TimePoint now() const noexcept = 0;
};

/// A span in seconds [s], for formulas.
[[nodiscard]] constexpr double seconds(Duration span) noexcept {
  return std::chrono::duration<double>(span).count();
}

/// The span nearest to `value` [s], |value| < 9e9.
[[nodiscard]] constexpr Duration from_seconds(double value) noexcept {
  const double nanoseconds = value * 1e9;
  return Duration{static_cast<std::int64_t>(nanoseconds + (nanoseconds < 0 ? -0.5 : 0.5))};
}

}  // namespace palp
