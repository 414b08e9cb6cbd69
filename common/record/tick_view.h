#pragma once

#include <algorithm>
#include <cstdint>

#include "common/record/recorder.h"

namespace palp::record {

/// 50 Hz: 20 ticks of 1 ms. Half a tick less, or a tick that is a little early joins the view
/// before and the rate falls.
inline constexpr Duration kViewInterval{std::chrono::microseconds{19500}};

/// A signal over some ticks: a spike of one tick stays visible.
struct SignalView {
  double newest{};  ///< [of the signal], as are the others
  double min{};     ///< [of the signal]
  double max{};     ///< [of the signal]

  void add(double value, bool first) noexcept {
    newest = value;
    min = first ? value : std::min(min, value);
    max = first ? value : std::max(max, value);
  }
};

/// Ticks of one interval, for eyes and slow plots.
struct TickView {
  TimePoint began_at{};
  std::uint32_t ticks{};
  bool gate_acted{};  ///< in any of them
  SiteTick newest;
  SignalView position;  ///< [m]
  SignalView velocity;  ///< [m/s]
  SignalView force;     ///< [N]
  SignalView command;   ///< [N] or [m]

  void add(const SiteTick& tick) noexcept {
    const bool first = ticks == 0;
    began_at = first ? tick.at : began_at;
    gate_acted = gate_acted || tick.gate_acted;
    newest = tick;
    position.add(tick.position, first);
    velocity.add(tick.velocity, first);
    force.add(tick.force, first);
    command.add(tick.command, first);
    ++ticks;
  }
};

}  // namespace palp::record
