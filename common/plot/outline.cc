#include "common/plot/outline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palp::plot {
namespace {

double column_of(const Spot& spot) { return std::floor(4 * spot.x); }

}  // namespace

std::vector<Spot> outline(const std::vector<Spot>& line) {
  std::vector<Spot> out;
  for (auto begin = line.begin(); begin != line.end();) {
    const auto end = std::find_if(
        begin, line.end(), [&](const Spot& spot) { return column_of(spot) != column_of(*begin); });
    const auto ends =
        std::minmax_element(begin, end, [](const Spot& a, const Spot& b) { return a.y < b.y; });
    std::array picked{begin, ends.first, ends.second, end - 1};
    std::sort(picked.begin(), picked.end());
    const auto* const last = std::unique(picked.begin(), picked.end());
    for (const auto* one = picked.begin(); one != last; ++one) out.push_back(**one);
    begin = end;
  }
  return out;
}

}  // namespace palp::plot
