#include "lab/report/locate_picture.h"

#include "common/core/conventions.h"

namespace palp::lab {
namespace {

constexpr std::size_t kBallsDrawn = 300;  // balls; more hide each other
constexpr double kBallOpacity = 0.7;      // [-], opacity
constexpr double kDeepest = 30;           // [mm]

/// One coordinate of the balls found, less `from` times its truth, over the true depth.
plot::Panel panel_of(const std::vector<LocateCase>& cases,
                     std::size_t coordinate,
                     double from,
                     const std::string& name) {
  plot::Panel panel{.axes = {.y_name = name}, .curves = {}};
  plot::Curve held{.name = "95 % interval",
                   .mark = plot::Mark::Intervals,
                   .colour = plot::kBlue,
                   .opacity = kBallOpacity};
  plot::Curve missed{.name = "interval that misses the truth",
                     .mark = plot::Mark::Intervals,
                     .colour = plot::kVermilion,
                     .opacity = kBallOpacity};
  std::size_t drawn = 0;
  for (const LocateCase& one : cases) {
    if (!one.inclusion || !one.found || drawn == kBallsDrawn) continue;
    ++drawn;
    const Located& told = one.coordinates[coordinate];
    const bool holds = told.low <= told.truth && told.truth <= told.high;
    plot::Curve& curve = holds ? held : missed;
    const double zero = from * told.truth;
    curve.x.push_back(one.coordinates[2].truth / kMillimetre);
    curve.y.push_back((told.median - zero) / kMillimetre);
    curve.low.push_back((told.low - zero) / kMillimetre);
    curve.high.push_back((told.high - zero) / kMillimetre);
  }
  for (plot::Curve* curve : {&held, &missed}) {
    if (!curve->x.empty()) panel.curves.push_back(std::move(*curve));
  }
  const double slope = 1 - from;
  panel.curves.push_back(
      {.name = "truth", .x = {0, kDeepest}, .y = {0, slope * kDeepest}, .colour = plot::kBlack});
  return panel;
}

}  // namespace

plot::Figure locate_figure(const std::vector<LocateCase>& cases) {
  plot::Figure figure{.title = "Balls found by taps at several places",
                      .panels = {panel_of(cases, 2, 0, "depth [mm]"),
                                 panel_of(cases, 0, 1, "error of x [mm]"),
                                 panel_of(cases, 3, 1, "error of the radius [mm]")}};
  figure.panels.back().axes.x_name = "true depth of the ball's top [mm]";
  return figure;
}

}  // namespace palp::lab
