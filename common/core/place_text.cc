#include "common/core/place_text.h"

#include <array>
#include <cstdio>

namespace palp {

std::string place_text(const Place& place) {
  if (distance(place, kSiteA) <= kNamedPlace) return "A";
  if (distance(place, kSiteB) <= kNamedPlace) return "B";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.4g,%.4g", place.x * 1e3, place.y * 1e3);
  return text.data();
}

}  // namespace palp
