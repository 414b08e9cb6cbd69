#pragma once

#include <string>

#include "common/core/place.h"

/// Places for people and reports. Thread: any; allocates.
namespace palp {

/// Within this distance a place is called by its site's name.
inline constexpr double kNamedPlace = 0.1e-3;  ///< [m]

/// "A", "B", or x and y in mm: "12.5,-3".
[[nodiscard]] std::string place_text(const Place& place);

}  // namespace palp
