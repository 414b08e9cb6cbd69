#pragma once

#include <string>
#include <vector>

#include "common/plot/style.h"

/// Every picture of Palp's programs: panels of curves, intervals and cells, as SVG.
namespace palp::plot {

enum class Mark {
  Line,
  Dashes,
  Points,
  Intervals,  ///< a point with a bar from `low` to `high`
  Cells       ///< filled squares, of classes
};

/// Colours of the palette, told apart by nearly everybody; the first two in grey print as well.
inline constexpr int kBlue = 0;
inline constexpr int kOrange = 1;
inline constexpr int kVermilion = 2;
inline constexpr int kGreen = 3;
inline constexpr int kBlack = 6;
inline constexpr int kGrey = 7;
inline constexpr std::size_t kCurveColours = 7;  ///< grey is for what is no curve

struct Curve {
  std::string name{};       ///< empty: not in the legend
  std::vector<double> x{};  ///< [as the axis]
  std::vector<double> y{};  ///< [as the axis]; not finite: no point, and a gap in a line
  Mark mark{Mark::Line};
  int colour{-1};              ///< of the palette; -1: the curve's place in the list
  std::vector<double> low{};   ///< [as the axis], of Intervals
  std::vector<double> high{};  ///< [as the axis], of Intervals
  double opacity{1};           ///< [-], 0 to 1
};

struct Axes {
  std::string title{};
  std::string x_name{};  ///< words and unit: "time, s"; empty: the panel below has the numbers
  std::string y_name{};
  bool x_logarithmic{};  ///< from 1 on; ticks where the first curve has points, if few
  double y_from{};       ///< [as the axis]
  double y_to{};         ///< [as the axis]; equal to y_from: as the curves need
  double height{1};      ///< [-], in heights of the style's panels; of numbers, not of classes
  std::vector<std::string> x_classes{};  ///< in place of numbers: those of x = 0, 1, ...
  std::vector<std::string> y_classes{};  ///< the same of y, from the top
};

struct Panel {
  Axes axes{};
  std::vector<Curve> curves{};
};

/// Panels one below the other.
struct Figure {
  std::string title{};
  std::vector<Panel> panels{};
};

/// Legends stand above their panel, where no curve is. Of a line with more points than the picture
/// can show those are drawn that make its outline.
[[nodiscard]] std::string figure_svg(const Figure& figure, const Style& style);

}  // namespace palp::plot
