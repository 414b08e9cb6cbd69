#include "review/session_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::review {

void SessionFigure::see(const judge::RunTick& tick) {
  if (tick.at >= span_.from && tick.at < span_.to) curves_.see(tick);
}

plot::Figure SessionFigure::figure() const {
  const std::vector<judge::RunTick> ticks = curves_.ticks();
  if (ticks.empty()) return {};
  const auto curve = [&](const char* name, auto value) {
    plot::Curve made{.name = name};
    for (const judge::RunTick& tick : ticks) {
      made.x.push_back(tick.at);
      made.y.push_back(value(tick));
    }
    return made;
  };
  // Where two agree both are seen: dashes over a line, over what is right.
  plot::Curve hand = curve("hand", [](const auto& tick) { return 1e3 * tick.hand; });
  plot::Curve tip = curve("tip", [](const auto& tick) { return 1e3 * tick.tip; });
  const plot::Curve surface{.name = "surface at rest",
                            .x = {ticks.front().at, ticks.back().at},
                            .y = {0, 0},
                            .colour = plot::kGrey};
  plot::Curve felt = curve("felt by the hand", [](const auto& tick) { return tick.hand_force; });
  plot::Curve touched =
      curve("touched by the tip", [](const auto& tick) { return tick.contact_force; });
  plot::Curve truth =
      curve("tissue's law at the hand", [](const auto& tick) { return tick.force_true; });
  for (plot::Curve* of_tip : {&tip, &touched}) {
    of_tip->mark = plot::Mark::Dashes;
    of_tip->colour = plot::kOrange;
  }
  for (plot::Curve* of_hand : {&hand, &felt}) of_hand->colour = plot::kBlue;
  truth.colour = plot::kGrey;
  const bool law_known = std::any_of(
      truth.y.begin(), truth.y.end(), [](double force) { return std::isfinite(force); });
  if (!law_known) truth.name.clear();  // a legend of what is there
  return {.title = "Hand and tip",
          .panels = {{.axes = {.y_name = "below the surface [mm]"},
                      .curves = {surface, std::move(hand), std::move(tip)}},
                     {.axes = {.x_name = "time [s]", .y_name = "force [N]"},
                      .curves = {std::move(truth), std::move(felt), std::move(touched)}}}};
}

}  // namespace palp::review
