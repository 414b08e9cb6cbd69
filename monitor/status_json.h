#pragma once

#include <cstddef>
#include <string>

#include "common/core/time.h"
#include "monitor/camera_feed.h"
#include "monitor/feed.h"
#include "monitor/pilot.h"

namespace palp::monitor {

/// The message of SITE/status: what a picture of the session needs at once, in mm, N and ms.
/// The site's own words, position to force, stand beside the same of its peer.
[[nodiscard]] std::string status_json(const LiveStatus& status,
                                      const Pilot& pilot,
                                      std::size_t clients);

/// The message of SITE/client: what the site knows of the client that it is sent to.
[[nodiscard]] std::string client_json(Duration round_trip);

/// The message of SITE/video: how the camera's pictures come, or why none does.
[[nodiscard]] std::string video_json(const VideoShown& shown);

/// Their JSON schemas, for tools that plot them.
[[nodiscard]] std::string status_schema();
[[nodiscard]] std::string client_schema();
[[nodiscard]] std::string video_schema();

}  // namespace palp::monitor
