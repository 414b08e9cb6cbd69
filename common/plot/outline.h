#pragma once

#include <vector>

namespace palp::plot {

/// A place in a picture, y downward.
struct Spot {
  double x{};  ///< [pt]
  double y{};  ///< [pt]
};

/// A line through fewer spots that looks the same: of neighbours that share a column of a quarter
/// of a point the first, the lowest, the highest and the last.
[[nodiscard]] std::vector<Spot> outline(const std::vector<Spot>& line);

}  // namespace palp::plot
