#include "depth/next_touch.h"

#include <algorithm>
#include <cmath>

#include "depth/seen_balls.h"

namespace palp::depth {
namespace {

constexpr double kGrid = 4e-3;         // [m]
constexpr double kRound = 12e-3;       // [m], farther than that from every touch nothing is sought
constexpr double kTouchError = 0.012;  // [-], of the force, of one touch

/// Of a touch that comes on top of those already there: they share the place's own stiffness.
double gain_at(const MapLikelihood& likelihood,
               double spread,
               const std::vector<SeenBall>& balls,
               const Place& place) {
  double mean = 0;
  double square = 0;
  for (const SeenBall& one : balls) {
    const double told = one.log_ratio(place);
    mean += told;
    square += told * told;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(balls.size(), 1));
  mean /= count;
  const double variance = std::max(0.0, square / count - mean * mean);
  // What is known of this place already, its own stiffness included, limits what more there is.
  const bool touched = std::any_of(
      likelihood.places().begin(), likelihood.places().end(), [&](const PlaceData& other) {
        return distance(other.place, place) <= kSamePlace;
      });
  const double error = touched ? kTouchError * kTouchError + variance + spread * spread
                               : kTouchError * kTouchError + spread * spread;
  return 0.5 * std::log1p(variance / error);
}

}  // namespace

double touch_gain(const MapLikelihood& likelihood,
                  const BallField& field,
                  const MapPosterior& posterior,
                  const Place& place) {
  const double spread = likelihood.rest(&posterior.best).spread;
  return gain_at(likelihood, spread, seen_balls(field, posterior), place);
}

std::optional<NextTouch> next_touch(const MapLikelihood& likelihood,
                                    const BallField& field,
                                    const MapPosterior& posterior,
                                    double travel) {
  const double spread = likelihood.rest(&posterior.best).spread;
  const std::vector<SeenBall> balls = seen_balls(field, posterior);
  Place low = likelihood.places().front().place;
  Place high = low;
  for (const PlaceData& touched : likelihood.places()) {
    low = {std::min(low.x, touched.place.x), std::min(low.y, touched.place.y)};
    high = {std::max(high.x, touched.place.x), std::max(high.y, touched.place.y)};
  }
  std::optional<NextTouch> best;
  const auto steps = [](double from, double to) {
    return static_cast<int>((to - from + 2 * kRound) / kGrid);
  };
  for (int i = 0; i <= steps(low.x, high.x); ++i) {
    for (int k = 0; k <= steps(low.y, high.y); ++k) {
      const Place place{low.x - kRound + i * kGrid, low.y - kRound + k * kGrid};
      if (std::abs(place.x) > travel || std::abs(place.y) > travel) continue;
      const double gain = gain_at(likelihood, spread, balls, place);
      if (!best || gain > best->gain) best = NextTouch{place, gain};
    }
  }
  return best;
}

}  // namespace palp::depth
