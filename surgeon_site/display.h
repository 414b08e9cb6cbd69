#pragma once

#include <string>

#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// The site in one line for a terminal, without newline: state and its cue, round trip, loss,
/// force, depth, progress. Pure. Thread: the display's; allocates.
[[nodiscard]] std::string status_line(const SurgeonStatus& status);

}  // namespace palp::surgeon
