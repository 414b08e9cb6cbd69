#pragma once

#include <chrono>
#include <cstdint>

#include "common/core/time.h"

namespace palp {

/// The time from one tick to the next, in whole periods: 1, or more where a tick came late.
///
/// One rule holds for laws, filters, accounts and gates of both sites. What was measured happened
/// in all of `passed()`: a velocity is a way divided by it, memories fade by it, and the force that
/// the device held meanwhile did its work over the whole way. What is done is done in one `period`:
/// no ramp, slew, fade or step makes good for a time in which nobody acted. A value.
struct Lapse {
  /// A tick that came in time.
  template <class Count, class Unit>
  // NOLINTNEXTLINE(google-explicit-constructor): so most ticks come
  constexpr Lapse(std::chrono::duration<Count, Unit> one) noexcept : period{one} {}
  constexpr Lapse(Duration one, std::int64_t count) noexcept : period{one}, periods{count} {}

  [[nodiscard]] constexpr Duration passed() const noexcept { return period * periods; }
  [[nodiscard]] constexpr bool late() const noexcept { return periods > 1; }
  /// [s], before the last period: so long the device held what it was told last.
  [[nodiscard]] constexpr double held() const noexcept { return seconds(period * (periods - 1)); }

  Duration period;          ///< > 0
  std::int64_t periods{1};  ///< >= 1

  friend constexpr bool operator==(const Lapse&, const Lapse&) = default;
};

/// A tick later than this is a fault: what was commanded is over, and the pedal must be pressed
/// again. The device has held a force that no law knew of, and gave the hand what no law can take
/// back: a hand at the usual 50 mm/s goes 2.5 mm in this time, on the stiffest tissue expected 1.2
/// mJ away from what the law would have given, as much as a tank holds. The other site waits twice
/// as long before it holds.
inline constexpr Duration kLateMax = std::chrono::milliseconds{50};

}  // namespace palp
