#pragma once

#include <vector>

#include "common/core/place.h"
#include "study/study_file.h"

/// How somebody goes over the area of a search who leaves nothing out. Pure.
namespace palp::study {

/// Middles of equal squares, in rows that are gone to and fro. As few as there may be with no point
/// of the area farther than `within` from the nearest one.
[[nodiscard]] std::vector<Place> raster(const SearchArea& area);

/// As many of them as the limit of the search lets somebody touch who needs `each` [s] for one, one
/// at least.
[[nodiscard]] std::vector<Place> raster_in_time(const SearchArea& area, double each);

/// From the first one to the last [m].
[[nodiscard]] double length_of(const std::vector<Place>& places) noexcept;

}  // namespace palp::study
