#include "depth/lateral_shape.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "depth/axis_stencil.h"

namespace palp::depth {
namespace {

// Far from a ball less than a thousandth of its effect is left, which drowns in the noise of the
// solver's cells; there it falls at least so fast. The limit far away is the sixth power.
constexpr double kFarFrom = 1.6;  // [-], offset over the depth of the centre
constexpr double kFarPower = 4;

std::vector<double> log_of(const std::vector<double>& values) {
  std::vector<double> out;
  for (const double value : values) out.push_back(std::log(value));
  return out;
}

/// Of a point inside the axis, or of its nearest end.
AxisStencil held_stencil(const std::vector<double>& axis, double x) noexcept {
  return axis_stencil(axis, std::clamp(x, axis.front(), axis.back()));
}

}  // namespace

LateralShape::LateralShape(const fem::ShapeTable& table)
    : depth_axis_{log_of(table.depths)},
      radius_axis_{log_of(table.radii)},
      offset_axis_{table.offsets},
      indentation_axis_{table.indentations} {
  for (const double ratio : table.ratios) ratio_axis_.push_back(ratio_coordinate(ratio));
  fall_.reserve(table.shape.size());
  const std::size_t rows = indentation_axis_.size();
  std::vector<double> logs;
  for (std::size_t i = 0; i < table.shape.size(); ++i) {
    const std::size_t at = i / rows % offset_axis_.size();
    const double offset = offset_axis_[at];
    double log = -std::log(static_cast<double>(table.shape[i]));
    if (offset > kFarFrom && at > 0) {
      log = std::max(log, logs[i - rows] + kFarPower * std::log(offset / offset_axis_[at - 1]));
    }
    logs.push_back(log);
    fall_.push_back(log / (offset * offset));
  }
}

LateralShape::OfBall LateralShape::of(double depth, double radius, double ratio) const {
  const AxisStencil by_depth = held_stencil(depth_axis_, std::log(depth));
  const AxisStencil by_radius = held_stencil(radius_axis_, std::log(radius));
  const AxisStencil by_ratio = held_stencil(ratio_axis_, ratio_coordinate(ratio));
  const std::size_t values = offset_axis_.size() * indentation_axis_.size();
  OfBall out{.centre = depth + radius, .fall = std::vector<double>(values)};
  for (std::size_t i = 0; i < by_depth.count; ++i) {
    for (std::size_t j = 0; j < by_radius.count; ++j) {
      for (std::size_t k = 0; k < by_ratio.count; ++k) {
        const double weight = by_depth.weight[i] * by_radius.weight[j] * by_ratio.weight[k];
        const std::size_t ball =
            ((by_depth.first + i) * radius_axis_.size() + by_radius.first + j) *
                ratio_axis_.size() +
            by_ratio.first + k;
        const double* from = &fall_[ball * values];
        for (std::size_t v = 0; v < values; ++v) out.fall[v] += weight * from[v];
      }
    }
  }
  return out;
}

double LateralShape::share(const OfBall& ball, double offset, double indentation) const noexcept {
  const double beside = std::abs(offset);
  if (!(beside < kReach)) return 0;
  const double s = beside / ball.centre;
  const AxisStencil by_offset = held_stencil(offset_axis_, s);
  const AxisStencil by_indentation = held_stencil(indentation_axis_, indentation);
  double fall = 0;
  for (std::size_t i = 0; i < by_offset.count; ++i) {
    const double* from =
        &ball.fall[(by_offset.first + i) * indentation_axis_.size() + by_indentation.first];
    for (std::size_t j = 0; j < by_indentation.count; ++j) {
      fall += by_offset.weight[i] * by_indentation.weight[j] * from[j];
    }
  }
  const double last = offset_axis_.back();
  const double inside = std::min(s, last);
  double share = std::exp(-std::max(0.0, fall) * inside * inside);
  if (s > last) {
    const double far = last / s;
    share *= far * far * far * far * far * far;
  }
  if (beside <= kFadesFrom) return share;
  const double t = (kReach - beside) / (kReach - kFadesFrom);
  return share * t * t * (3 - 2 * t);
}

}  // namespace palp::depth
