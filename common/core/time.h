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

/// later - earlier for instants that come out of a file or off a wire and may be anything: where
/// the difference does not fit, the longest span of its sign.
template <class Line, class Span>
[[nodiscard]] constexpr Span elapsed(std::chrono::time_point<Line, Span> earlier,
                                     std::chrono::time_point<Line, Span> later) noexcept {
  const auto from = earlier.time_since_epoch().count();
  const auto to = later.time_since_epoch().count();
  typename Span::rep difference{};
  return __builtin_sub_overflow(to, from, &difference) ? (to < from ? Span::min() : Span::max())
                                                       : Span{difference};
}

/// A span in seconds [s], for formulas.
[[nodiscard]] constexpr double seconds(Duration span) noexcept {
  return std::chrono::duration<double>(span).count();
}

/// The whole second in which an instant lies, counted on its line.
[[nodiscard]] constexpr std::int64_t second_of(TimePoint at) noexcept {
  return std::chrono::floor<std::chrono::seconds>(at).time_since_epoch().count();
}

/// The span nearest to `value` [s], |value| < 9e9.
[[nodiscard]] constexpr Duration from_seconds(double value) noexcept {
  const double nanoseconds = value * 1e9;
  return Duration{static_cast<std::int64_t>(nanoseconds + (nanoseconds < 0 ? -0.5 : 0.5))};
}

}  // namespace palp
