#pragma once

#include <algorithm>
#include <cstdint>

#include "common/message/record.h"

namespace palp {

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

namespace message {

template <std::same_as<TickView> S>
inline constexpr auto fields<S> =
    list({.log = "SurgeonTickView", .log_patient = "PatientTickView"},
         aside<&S::began_at>("began_at_ns"),
         aside<&S::newest>("newest"),
         field<1, &S::newest, &SiteTick::state>("state"),
         field<2, &S::ticks>("ticks"),
         field<3, &S::gate_acted>("gate_acted"),
         field<4, &S::position, &SignalView::newest>("position_m"),
         field<5, &S::position, &SignalView::min>("position_min_m"),
         field<6, &S::position, &SignalView::max>("position_max_m"),
         field<7, &S::velocity, &SignalView::newest>("velocity_m_per_s"),
         field<8, &S::velocity, &SignalView::min>("velocity_min_m_per_s"),
         field<9, &S::velocity, &SignalView::max>("velocity_max_m_per_s"),
         field<10, &S::force, &SignalView::newest>("force_n"),
         field<11, &S::force, &SignalView::min>("force_min_n"),
         field<12, &S::force, &SignalView::max>("force_max_n"),
         field<13, &S::command, &SignalView::newest>({"command_n", "command_m"}),
         field<14, &S::command, &SignalView::min>({"command_min_n", "command_min_m"}),
         field<15, &S::command, &SignalView::max>({"command_max_n", "command_max_m"}),
         field<16, &S::newest, &SiteTick::place, &Place::x>("x_m"),
         field<17, &S::newest, &SiteTick::round_trip>("round_trip_ns"),
         field<18, &S::newest, &SiteTick::place, &Place::y>("y_m"));

}  // namespace message
}  // namespace palp
