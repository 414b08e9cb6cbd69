#include "study/raster.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace palp::study {

std::vector<Place> raster(const SearchArea& area) {
  constexpr double kWhole = 1e-9;  // [-], so that rounding makes no further row
  const auto side =
      static_cast<std::size_t>(std::ceil(area.side / (std::numbers::sqrt2 * area.within) - kWhole));
  const double pitch = area.side / static_cast<double>(side);
  const auto along = [&](std::size_t i) {
    return pitch * (static_cast<double>(i) + 0.5) - area.side / 2;
  };
  std::vector<Place> out;
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t i = 0; i < side; ++i) {
      out.push_back({along(row % 2 == 0 ? i : side - 1 - i), along(row)});
    }
  }
  return out;
}

double raster_length(const SearchArea& area) {
  const std::vector<Place> places = raster(area);
  double length = 0;
  for (std::size_t i = 1; i < places.size(); ++i) length += distance(places[i - 1], places[i]);
  return length;
}

}  // namespace palp::study
