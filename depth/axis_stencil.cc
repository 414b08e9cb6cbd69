#include "depth/axis_stencil.h"

#include <algorithm>

namespace palp::depth {

AxisStencil axis_stencil(const std::vector<double>& axis, double x) noexcept {
  constexpr std::size_t kWidth = 4;
  const std::size_t count = axis.size();
  AxisStencil out{.count = std::min(count, kWidth)};
  if (count < 3) {
    const double t = count == 2 ? (x - axis[0]) / (axis[1] - axis[0]) : 0;
    out.weight = {1 - t, t, 0, 0};
    return out;
  }
  const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, x);
  const auto cell = static_cast<std::size_t>(above - axis.begin()) - 1;
  out.first = std::min(cell == 0 ? 0 : cell - 1, count - out.count);
  const double width = axis[cell + 1] - axis[cell];
  const double t = (x - axis[cell]) / width;
  const auto add_slope = [&](std::size_t node, double weight) {
    const std::size_t middle = std::clamp<std::size_t>(node, 1, count - 2);
    const std::array<double, 3> at{axis[middle - 1], axis[middle], axis[middle + 1]};
    for (std::size_t i = 0; i < 3; ++i) {  // derivative of Lagrange's polynomials
      const double a = at[(i + 1) % 3];
      const double b = at[(i + 2) % 3];
      out.weight[middle - 1 + i - out.first] +=
          weight * (2 * axis[node] - a - b) / ((at[i] - a) * (at[i] - b));
    }
  };
  out.weight[cell - out.first] += 1 + t * t * (2 * t - 3);
  out.weight[cell + 1 - out.first] += t * t * (3 - 2 * t);
  add_slope(cell, width * t * (1 - t) * (1 - t));
  add_slope(cell + 1, width * t * t * (t - 1));
  return out;
}

}  // namespace palp::depth
