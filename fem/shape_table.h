#pragma once

#include <vector>

#include "common/core/result.h"

namespace palp::fem {

/// What is left of a ball's effect on the force beside its axis: g of off_axis_curve.h, on a grid.
/// Offsets are counted in the depth of the ball's centre, over which g is nearly one curve for all
/// balls. What was solved, nothing interpolated. A value. Thread: any.
struct ShapeTable {
  std::vector<double> depths;        ///< [m], of the ball's top, rising
  std::vector<double> radii;         ///< [m], rising
  std::vector<double> ratios;        ///< [-], rising, above 1
  std::vector<double> offsets;       ///< [-], rising, above 0, over depth + radius
  std::vector<double> indentations;  ///< [m], rising, above 0
  /// [-], in ]0, 1[; depth runs slowest, then radius, ratio, offset, indentation.
  std::vector<float> shape;

  /// Number of values of one ball.
  [[nodiscard]] std::size_t ball_size() const noexcept {
    return offsets.size() * indentations.size();
  }
};

/// Whether the axes rise and every value is there and sound.
[[nodiscard]] Result<void> check(const ShapeTable& table);

}  // namespace palp::fem
