#pragma once

#include <string>
#include <vector>

namespace palp::plot {

enum class Mark { Line, Dashes, Points };

struct Curve {
  std::string name{};       ///< empty: not in the legend
  std::vector<double> x{};  ///< [as the axis]
  std::vector<double> y{};  ///< [as the axis]; not finite: no point
  Mark mark{Mark::Line};
  int colour{-1};  ///< of the palette; -1: the curve's place in the list
};

struct Axes {
  std::string title{};
  std::string x_name{};
  std::string y_name{};
  bool x_logarithmic{};  ///< from 1 on; ticks where the first curve has points, if few
  double y_from{};       ///< [as the axis]
  double y_to{};         ///< [as the axis]; equal to y_from: as the curves need
};

struct Panel {
  Axes axes;
  std::vector<Curve> curves;
};

/// One panel.
[[nodiscard]] std::string curves_svg(const Axes& axes, const std::vector<Curve>& curves);
/// Panels one below the other.
[[nodiscard]] std::string panels_svg(const std::vector<Panel>& panels);

/// Round places from at most `from` to at least `to`, about `count` of them.
[[nodiscard]] std::vector<double> round_ticks(double from, double to, int count);

}  // namespace palp::plot
