#include "judge/excursions.h"

#include <algorithm>
#include <optional>

namespace palp::judge {
namespace {

/// The ticks [begin, end) as an excursion, if they went deep enough.
std::optional<Excursion> excursion_of(std::span<const Motion> ticks, double surface) {
  const auto deepest =
      std::max_element(ticks.begin(), ticks.end(), [](const Motion& a, const Motion& b) {
        return a.position < b.position;
      });
  if (deepest == ticks.end() || deepest->position - surface <= kStrokeDepthMin) {
    return std::nullopt;
  }
  const auto loading_size = static_cast<std::size_t>(deepest - ticks.begin()) + 1;
  return Excursion{.place = deepest->place,
                   .began_at = ticks.front().at,
                   .ended_at = ticks.back().at,
                   .loading = ticks.first(loading_size)};
}

}  // namespace

std::vector<Excursion> find_excursions(std::span<const Motion> motion, double surface) {
  std::vector<Excursion> excursions;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= motion.size(); ++k) {
    const bool inside = k < motion.size() && motion[k].position - surface > 0.5 * kStrokeDepthMin;
    if (inside) {
      continue;
    }
    if (k > begin) {
      if (const auto excursion = excursion_of(motion.subspan(begin, k - begin), surface)) {
        excursions.push_back(*excursion);
      }
    }
    begin = k + 1;
  }
  return excursions;
}

FeltStiffness stiffness_of(const Excursion& excursion, double surface, const TissueTable* tissue) {
  FeltStiffness stiffness;
  for (const Motion& tick : excursion.loading) {
    const double indentation = tick.position - surface;
    const auto truth =
        tissue == nullptr ? std::nullopt : tissue->force(excursion.place, indentation);
    stiffness.add(indentation, tick.velocity, tick.force, truth);
  }
  return stiffness;
}

}  // namespace palp::judge
