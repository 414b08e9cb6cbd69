#include "common/core/fitted_line.h"

#include <algorithm>
#include <vector>

namespace palp {
namespace {

std::string joined(std::span<const LinePart> parts) {
  std::string line;
  for (const LinePart& part : parts) {
    if (part.full.empty()) continue;
    if (!line.empty()) line += "  ";
    line += part.full;
  }
  return line;
}

}  // namespace

std::string fitted_line(std::span<LinePart> parts, std::size_t columns) {
  std::vector<LinePart*> order;
  order.reserve(parts.size());
  for (LinePart& part : parts) order.push_back(&part);
  std::ranges::stable_sort(order, {}, [](const LinePart* part) { return part->rank; });
  std::string line = joined(parts);
  if (columns == 0) return line;
  for (LinePart* part : order) {
    if (line.size() <= columns) break;
    part->full = part->brief;
    line = joined(parts);
  }
  return line;
}

}  // namespace palp
