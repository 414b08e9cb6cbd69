#pragma once

#include <vector>

#include "common/config/json.h"
#include "common/message/map_report.h"

namespace palp::judge {

/// What the touches at all places say together, as reports have it; null where the touches were at
/// too few places. Verdict "not_trusted": found, and its numbers are doubted.
[[nodiscard]] config::Json map_json(const MapReport& map, const std::vector<MapCell>& cells = {});

}  // namespace palp::judge
