#pragma once

#include "common/config/json.h"
#include "common/message/map_report.h"

namespace palp::review {

/// What the touches at all places say together, as reports have it; null where the touches were at
/// too few places. Verdict "not_trusted": found, and its numbers are doubted.
[[nodiscard]] config::Json map_json(const MapReport& map);

}  // namespace palp::review
