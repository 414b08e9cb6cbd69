#include "study/raster.h"

#include <algorithm>
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

std::vector<Place> raster_in_time(const SearchArea& area, double each) {
  std::vector<Place> out = raster(area);
  const auto most = static_cast<std::size_t>(std::max(1.0, std::floor(area.limit / each)));
  if (most < out.size()) out.resize(most);
  return out;
}

double length_of(const std::vector<Place>& places) noexcept {
  double length = 0;
  for (std::size_t i = 1; i < places.size(); ++i) length += distance(places[i - 1], places[i]);
  return length;
}

}  // namespace palp::study
