#pragma once

#include <string>

#include "relay/rooms.h"

namespace palp::relay {

/// One line for people: what was done so far.
[[nodiscard]] std::string status_line(const Rooms& rooms);
/// Schema palp.rooms/1. `span`: how long the relay has run.
[[nodiscard]] std::string to_json(const RoomCounts& counts, Duration span);

}  // namespace palp::relay
