#include "lab/stability_map.h"

#include <algorithm>

#include "common/plot/svg_text.h"

namespace palp::lab {
namespace {

constexpr double kLeft = 54;     // [px]
constexpr double kTop = 60;      // [px]
constexpr double kAcross = 34;   // [px], a cell and its gap; "1000" fits below
constexpr double kDown = 22;     // [px]
constexpr double kBetween = 54;  // [px], between panels

}  // namespace

std::string map_svg(const Plan& plan, const std::vector<CaseResult>& results) {
  const auto at = [&](const std::string& name) {
    const auto found = std::find(plan.label_names.begin(), plan.label_names.end(), name);
    return static_cast<std::size_t>(found - plan.label_names.begin());
  };
  const std::size_t spring_at = at("k_p_n_per_m");
  const std::size_t trip_at = at("rtt_ms");
  const std::size_t grip_at = at("grip");
  std::vector<std::string> springs;
  std::vector<std::string> trips;
  std::vector<std::string> grips;
  const auto index_in = [](std::vector<std::string>& list, const std::string& value) {
    auto found = std::find(list.begin(), list.end(), value);
    if (found == list.end()) found = list.insert(list.end(), value);
    return static_cast<double>(found - list.begin());
  };
  for (const CaseResult& result : results) (void)index_in(springs, result.labels[spring_at]);
  const std::size_t rows = springs.size();
  const double panel_height = kDown * static_cast<double>(rows) + kBetween;
  std::string cells;
  for (const CaseResult& result : results) {
    const double row = index_in(springs, result.labels[spring_at]);
    const double column = index_in(trips, result.labels[trip_at]);
    const double panel = index_in(grips, result.labels[grip_at]);
    plot::append(cells,
                 "<rect x=\"%.0f\" y=\"%.0f\" width=\"32\" height=\"20\" fill=\"%s\"/>\n",
                 kLeft + kAcross * column,
                 kTop + panel_height * panel + kDown * row,
                 result.unstable ? "#d55e00" : "#009e73");
  }
  const double width = kLeft + 20 + kAcross * static_cast<double>(trips.size());
  std::string text =
      plot::open_picture(width, kTop + panel_height * static_cast<double>(grips.size()));
  plot::title(text, kLeft, 22, "eq. (1): stable (green), unstable (orange)");
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const double top = kTop + panel_height * static_cast<double>(g);
    plot::label(
        text, kLeft, top - 8, "start", "grip " + grips[g] + ": k_p [N/m] over the round trip [ms]");
    for (std::size_t r = 0; r < springs.size(); ++r) {
      plot::label(text, kLeft - 8, top + 15 + kDown * static_cast<double>(r), "end", springs[r]);
    }
    for (std::size_t c = 0; c < trips.size(); ++c) {
      plot::label(text,
                  kLeft + 16 + kAcross * static_cast<double>(c),
                  top + kDown * static_cast<double>(rows) + 14,
                  "middle",
                  trips[c]);
    }
  }
  return text + cells + "</svg>\n";
}

}  // namespace palp::lab
