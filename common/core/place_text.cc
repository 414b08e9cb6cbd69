#include "common/core/place_text.h"

#include <cmath>

#include "common/core/formatted.h"

namespace palp {

std::string place_text(const Place& place) {
  if (distance(place, kSiteA) <= kNamedPlace) return "A";
  if (distance(place, kSiteB) <= kNamedPlace) return "B";
  // What is left of zero after a hand's way is no place of its own; nor is minus zero.
  const auto shown = [](double value) { return std::round(value * 1e6) / 1e3 + 0.0; };
  return formatted("%.4g,%.4g", shown(place.x), shown(place.y));
}

}  // namespace palp
