#include "lab/stability_map.h"

#include <algorithm>

#include "common/plot/svg_text.h"

namespace palp::lab {
namespace {

constexpr double kLeft = 70;  // [px]
constexpr double kTop = 40;   // [px]

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
  constexpr double kCell = 22;
  constexpr double kPanel = 8 * kCell + 46;
  std::string cells;
  for (const CaseResult& result : results) {
    const double row = index_in(springs, result.labels[spring_at]);
    const double column = index_in(trips, result.labels[trip_at]);
    const double panel = index_in(grips, result.labels[grip_at]);
    plot::append(cells,
                 "<rect x=\"%.0f\" y=\"%.0f\" width=\"20\" height=\"20\" fill=\"%s\"/>\n",
                 kLeft + 30 + kCell * column,
                 kTop + 20 + kPanel * panel + kCell * row,
                 result.unstable ? "#d55e00" : "#009e73");
  }
  const double width = kLeft + 60 + kCell * static_cast<double>(trips.size());
  std::string text =
      plot::open_picture(width, kTop + kPanel * static_cast<double>(grips.size()) + 10);
  plot::title(text, kLeft, 22, "eq. (1): stable (green), unstable (orange)");
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const double top = kTop + 20 + kPanel * static_cast<double>(g);
    plot::label(text, kLeft + 30, top - 6, "start", "grip " + grips[g]);
    for (std::size_t r = 0; r < springs.size(); ++r) {
      plot::label(text, kLeft + 24, top + 15 + kCell * static_cast<double>(r), "end", springs[r]);
    }
    for (std::size_t c = 0; c < trips.size(); ++c) {
      plot::label(text,
                  kLeft + 40 + kCell * static_cast<double>(c),
                  top + kCell * 8 + 12,
                  "middle",
                  trips[c]);
    }
  }
  plot::label(text, 6, kTop + 8, "start", "k_p N/m by round trip ms");
  return text + cells + "</svg>\n";
}

}  // namespace palp::lab
