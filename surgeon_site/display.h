#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// The site in one line for a terminal, without newline: state and its cue, round trip, loss,
/// force, depth, progress. In `columns` (0: any) those four come first, the rest is shortened or
/// left out. Pure. Thread: the display's; allocates.
[[nodiscard]] std::string status_line(const SurgeonStatus& status, std::size_t columns = 0);

}  // namespace palp::surgeon
