#include "depth/stiffness_map.h"

#include <algorithm>
#include <cmath>

#include "depth/seen_balls.h"

namespace palp::depth {
namespace {

constexpr double kBorder = 12e-3;   // [m], about the touched places
constexpr double kPitchMin = 2e-3;  // [m]

/// Along one coordinate.
struct Axis {
  double first{};  ///< [m]
  double pitch{};  ///< [m]
  int count{};
};

Axis axis_over(double low, double high) {
  const double length = high - low + 2 * kBorder;
  const double pitch = std::max(kPitchMin, length / (kMapSideMax - 1));
  const int count = 1 + static_cast<int>(length / pitch + 1e-6);
  return {low - kBorder, pitch, std::min(count, static_cast<int>(kMapSideMax))};
}

MapCell cell_at(const Place& place,
                const std::vector<SeenBall>& balls,
                double probability,
                const FieldTold& own) {
  double mean = 0;
  double square = 0;
  double below = 0;
  for (const SeenBall& seen : balls) {
    const double told = seen.log_ratio(place);
    mean += told;
    square += told * told;
    if (distance(seen.ball.place, place) < seen.ball.radius) ++below;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(balls.size(), 1));
  mean *= probability / count;
  square *= probability / count;
  return {.place = place,
          .stiffness = std::exp(mean + own.mean),
          .stiffness_stddev = std::sqrt(std::max(0.0, square - mean * mean) + own.variance),
          .inclusion = probability * below / count};
}

}  // namespace

std::vector<MapCell> stiffness_map(const MapLikelihood& likelihood,
                                   const BallField& field,
                                   const MapPosterior& posterior) {
  Place low = likelihood.places().front().place;
  Place high = low;
  for (const PlaceData& touched : likelihood.places()) {
    low = {std::min(low.x, touched.place.x), std::min(low.y, touched.place.y)};
    high = {std::max(high.x, touched.place.x), std::max(high.y, touched.place.y)};
  }
  const Axis x = axis_over(low.x, high.x);
  const Axis y = axis_over(low.y, high.y);
  const std::vector<SeenBall> balls = seen_balls(field, posterior);
  const double probability = 1 / (1 + std::exp(-posterior.log_evidence));
  std::vector<Place> places;
  for (int row = 0; row < y.count; ++row) {
    for (int column = 0; column < x.count; ++column) {
      places.push_back({x.first + column * x.pitch, y.first + row * y.pitch});
    }
  }
  const auto rest = likelihood.rest(probability > 0.5 ? &posterior.best : nullptr);
  const std::vector<FieldTold> own = likelihood.told(rest, places);
  std::vector<MapCell> cells;
  for (std::size_t i = 0; i < places.size(); ++i) {
    cells.push_back(cell_at(places[i], balls, probability, own[i]));
  }
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    cells[i].index = i;
    cells[i].count = static_cast<std::uint32_t>(cells.size());
  }
  return cells;
}

}  // namespace palp::depth
