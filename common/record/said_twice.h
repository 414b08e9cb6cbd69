#pragma once

#include "common/message/given.h"

/// What a tick says twice stands in its message once: session_log.proto says what and where.
/// Thread: any.
namespace palp::record {

/// nullptr: no fresh sample is there.
template <class Given>
[[nodiscard]] Arrived* newest_fresh(Given& given) noexcept {
  if (given.samples > 0 && given.arrived.incoming.fresh) return &given.arrived;
  return given.samples > 1 && given.earlier.incoming.fresh ? &given.earlier : nullptr;
}

/// Leaves out what follows from the rest.
/// @returns false, with nothing changed, where it does not follow.
template <class FileTick>
[[nodiscard]] bool leave_out(FileTick& tick) noexcept {
  if (tick.given.heard.round_trip != tick.tick.round_trip) return false;
  Arrived* const newest = newest_fresh(tick.given);
  if (newest != nullptr) {
    if (newest->incoming.arrived_at != tick.at - tick.given.heard.gap) return false;
    newest->incoming.arrived_at = {};
  }
  tick.given.heard.round_trip = {};
  return true;
}

/// The reverse of leave_out(); `tick` knows its instant.
template <class FileTick>
void put_back(FileTick& tick) noexcept {
  tick.given.heard.round_trip = tick.tick.round_trip;
  Arrived* const newest = newest_fresh(tick.given);
  if (newest != nullptr) newest->incoming.arrived_at = tick.at - tick.given.heard.gap;
}

}  // namespace palp::record
