#pragma once

#include <cstddef>
#include <string>

#include "monitor/feed.h"
#include "monitor/pilot.h"

namespace palp::monitor {

/// The message of SITE/status: what a picture of the session needs at once, in mm, N and ms.
/// The site's own words, position to force, stand beside the same of its peer.
[[nodiscard]] std::string status_json(const LiveStatus& status,
                                      const Pilot& pilot,
                                      std::size_t clients);

/// Its JSON schema, for tools that plot it.
[[nodiscard]] std::string status_schema();

}  // namespace palp::monitor
