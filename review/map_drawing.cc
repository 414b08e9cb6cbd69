#include "review/map_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "common/core/conventions.h"
#include "common/core/formatted.h"

namespace palp::review {
namespace {

constexpr std::string_view kShades = " .:=#@";
constexpr double kMicrometre = 1e-6;

/// Exact in a map's keys.
long micrometres(double metres) { return std::lround(metres / kMicrometre); }

char shade_of(const MapCell& cell) {
  const double share = std::clamp(cell.inclusion, 0.0, 1.0);
  const auto last = static_cast<double>(kShades.size() - 1);
  return kShades[static_cast<std::size_t>(std::lround(share * last))];
}

}  // namespace

std::string map_drawing(const MapReport& report, const std::vector<MapCell>& cells) {
  if (cells.empty()) return {};
  std::map<long, std::map<long, char>> rows;
  for (const MapCell& cell : cells) {
    rows[micrometres(cell.place.y)][micrometres(cell.place.x)] = shade_of(cell);
  }
  const auto mark = [&](const Place& at, char letter) {
    const auto nearest = std::ranges::min_element(
        cells, {}, [&](const MapCell& cell) { return distance(cell.place, at); });
    rows[micrometres(nearest->place.y)][micrometres(nearest->place.x)] = letter;
  };
  if (report.stop == MapStop::GoOn) mark(report.next, 'x');
  if (report.verdict == DepthVerdict::Found) mark({report.x.median, report.y.median}, '+');
  std::string text =
      "how likely an inclusion lies below: blank 0, \".:=#@\" 20 to 100 %; + its "
      "axis, x the next tap\n";
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    text += formatted("%6.1f |", static_cast<double>(row->first) * kMicrometre / kMillimetre);
    // Two letters wide, for a letter is twice as high.
    for (const auto& [x, letter] : row->second)
      text += {letter, letter == '+' || letter == 'x' ? ' ' : letter};
    text += "|\n";
  }
  const auto& columns = rows.begin()->second;
  return text + formatted("y mm    x %.1f to %.1f mm\n",
                          static_cast<double>(columns.begin()->first) * kMicrometre / kMillimetre,
                          static_cast<double>(columns.rbegin()->first) * kMicrometre / kMillimetre);
}

}  // namespace palp::review
