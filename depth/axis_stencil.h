#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palp::depth {

/// Interpolation between points of an axis: Hermite's cubic of the cell that holds x, slopes by the
/// parabola through three points (at the ends: the last three), written as weights of the points
/// round it. Exact at the points and for parabolas, with continuous slope. Two points: a line; one:
/// a constant. Beyond the ends it goes on as the last cell does.
struct AxisStencil {
  std::size_t first{};             ///< index of the first point that counts
  std::size_t count{};             ///< how many do: 4, or all points where there are fewer
  std::array<double, 4> weight{};  ///< [-]; 0 from `count` on
};

/// `axis` holds one rising number or more. Allocates nothing. Thread: any.
[[nodiscard]] AxisStencil axis_stencil(const std::vector<double>& axis, double x) noexcept;

}  // namespace palp::depth
