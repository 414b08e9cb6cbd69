#include "fem/shape_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace palp::fem {
namespace {

constexpr std::size_t kShapeAxisMax = 100;

/// Between two neighbours of an axis.
struct Between {
  std::size_t low{};
  double share{};  ///< [-], of the upper one
};

template <typename Map>
Between find(const std::vector<double>& axis, double value, const Map& map) {
  const double inside = std::clamp(value, axis.front(), axis.back());
  if (axis.size() == 1) return {};
  const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, inside);
  const double low = map(*(above - 1));
  return {static_cast<std::size_t>(above - axis.begin()) - 1,
          (map(inside) - low) / (map(*above) - low)};
}

double logarithm(double value) { return std::log(value); }
double itself(double value) { return value; }
/// What a ball does to the field far from it (Eshelby).
double contrast(double ratio) { return (ratio - 1) / (ratio + 1.5); }

bool rises(const std::vector<double>& axis, double above) {
  const auto falls = [](double a, double b) { return !(a < b); };
  return !axis.empty() && axis.size() <= kShapeAxisMax && axis.front() > above &&
         std::isfinite(axis.back()) &&
         std::adjacent_find(axis.begin(), axis.end(), falls) == axis.end();
}

}  // namespace

std::size_t ShapeTable::first_of(std::size_t depth, std::size_t radius, std::size_t ratio) const {
  return ((depth * radii.size() + radius) * ratios.size() + ratio) * ball_size();
}

double ShapeTable::at(const Place& place) const {
  const double offset = std::abs(place.offset) / (place.depth + place.radius);
  const double far = std::max(1.0, offset / offsets.back());
  const std::array<Between, 5> corner{find(depths, place.depth, logarithm),
                                      find(radii, place.radius, logarithm),
                                      find(ratios, place.ratio, contrast),
                                      find(offsets, offset, itself),
                                      find(indentations, place.indentation, itself)};
  double fall = 0;  // -ln(g) / offset^2
  for (unsigned bits = 0; bits < 32; ++bits) {
    double weight = 1;
    std::array<std::size_t, 5> index{};
    for (std::size_t axis = 0; axis < 5; ++axis) {
      const bool upper = (bits >> axis & 1U) != 0;
      weight *= upper ? corner[axis].share : 1 - corner[axis].share;
      index[axis] = corner[axis].low + (upper ? 1 : 0);
    }
    if (weight == 0) continue;
    const std::size_t entry =
        first_of(index[0], index[1], index[2]) + index[3] * indentations.size() + index[4];
    const double s = offsets[index[3]];
    fall -= weight * std::log(static_cast<double>(shape[entry])) / (s * s);
  }
  const double s = std::min(offset, offsets.back());
  return std::exp(-fall * s * s) / std::pow(far, 6);
}

Result<void> check(const ShapeTable& table) {
  if (!rises(table.depths, 0) || !rises(table.radii, 0) || !rises(table.ratios, 1) ||
      !rises(table.offsets, 0) || !rises(table.indentations, 0)) {
    return fail("the axes of the shape beside a ball are not 1 to 100 rising positive numbers");
  }
  const std::size_t wanted =
      table.depths.size() * table.radii.size() * table.ratios.size() * table.ball_size();
  const bool sound = std::all_of(
      table.shape.begin(), table.shape.end(), [](float value) { return value > 0 && value < 1; });
  if (table.shape.size() != wanted || !sound) {
    return fail("the shape beside a ball has " + std::to_string(table.shape.size()) +
                " values, expected " + std::to_string(wanted) + " between 0 and 1");
  }
  return {};
}

}  // namespace palp::fem
