#pragma once

#include <string>
#include <vector>

#include "common/message/map_report.h"

namespace palp::review {

/// The stiffness map for a terminal, y upwards: the darker a letter the likelier an inclusion lies
/// below, "+" where its axis is, "x" where the next tap tells most. Empty where there is no map.
[[nodiscard]] std::string map_drawing(const MapReport& report, const std::vector<MapCell>& cells);

}  // namespace palp::review
