#include "fem/shape_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace palp::fem {
namespace {

constexpr std::size_t kShapeAxisMax = 100;

bool rises(const std::vector<double>& axis, double above) {
  const auto falls = [](double a, double b) { return !(a < b); };
  return !axis.empty() && axis.size() <= kShapeAxisMax && axis.front() > above &&
         std::isfinite(axis.back()) &&
         std::adjacent_find(axis.begin(), axis.end(), falls) == axis.end();
}

}  // namespace

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
