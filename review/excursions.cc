#include "review/excursions.h"

#include <algorithm>

namespace palp::review {
namespace {

struct Point {
  double x{};
  double y{};
};

/// Slope of the least-squares line with intercept; nullopt: too few points, or all at one x.
std::optional<double> slope(const std::vector<Point>& points) {
  if (points.size() < kFitTicksMin) {
    return std::nullopt;
  }
  Point mean;
  for (const Point& point : points) {
    mean.x += point.x / static_cast<double>(points.size());
    mean.y += point.y / static_cast<double>(points.size());
  }
  double xx = 0;
  double xy = 0;
  for (const Point& point : points) {
    xx += (point.x - mean.x) * (point.x - mean.x);
    xy += (point.x - mean.x) * (point.y - mean.y);
  }
  return xx > 0 ? std::optional{xy / xx} : std::nullopt;
}

/// The ticks [begin, end) as an excursion, if they went deep enough.
std::optional<Excursion> judge(std::span<const Motion> ticks, double surface) {
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
      if (const auto excursion = judge(motion.subspan(begin, k - begin), surface)) {
        excursions.push_back(*excursion);
      }
    }
    begin = k + 1;
  }
  return excursions;
}

Stiffness fit_stiffness(const Excursion& excursion, double surface, const TissueTable* tissue) {
  std::vector<Point> felt;
  std::vector<Point> truth;
  for (const Motion& tick : excursion.loading) {
    const double indentation = tick.position - surface;
    if (tick.velocity <= 0 || indentation <= kFitBegin || indentation >= kFitEnd) {
      continue;
    }
    felt.push_back({.x = tick.position, .y = tick.force});
    const auto force =
        tissue == nullptr ? std::nullopt : tissue->force(excursion.place, indentation);
    if (force) {
      truth.push_back({.x = tick.position, .y = *force});
    }
  }
  const bool whole = truth.size() == felt.size();  // a table that ends below says nothing
  return {.felt = slope(felt), .truth = whole ? slope(truth) : std::nullopt};
}

}  // namespace palp::review
