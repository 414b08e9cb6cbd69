#pragma once

#include <string>
#include <vector>

#include "lab/batch.h"
#include "lab/plan.h"

/// Plots a person can look at, as SVG text without any style sheet or script.
namespace palp::lab {

struct Curve {
  std::string name;
  std::vector<double> x;  ///< [as the axis]
  std::vector<double> y;  ///< [as the axis]; not finite: no point
};

struct Axes {
  std::string title;
  std::string x_name;
  std::string y_name;
  bool x_logarithmic{};
  double y_from{};  ///< [as the axis]
  double y_to{};    ///< [as the axis]; equal to y_from: as the curves need
};

[[nodiscard]] std::string curves_svg(const Axes& axes, const std::vector<Curve>& curves);

/// One square a run: rows of springs, columns of round trips, one panel per grip.
[[nodiscard]] std::string map_svg(const Plan& plan, const std::vector<CaseResult>& results);

}  // namespace palp::lab
