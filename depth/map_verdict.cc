#include "depth/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::depth {
namespace {

constexpr double kApart = 3e-3;  // [m]; two tops of the posterior nearer than that are one place

/// Share of the posterior outside of the box that the touched places span, and half their distance
/// more.
double share_outside(const MapLikelihood& likelihood, const MapPosterior& posterior) {
  const auto& places = likelihood.places();
  Place low = places.front().place;
  Place high = low;
  double apart = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i].place;
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
    for (std::size_t j = 0; j < i; ++j) apart = std::min(apart, distance(place, places[j].place));
  }
  const double rim = std::isfinite(apart) ? 0.5 * apart : 0;
  double share = 0;
  for (const LikelyBall& one : posterior.balls) {
    const Place& at = one.ball.place;
    const bool inside =
        at.x > low.x - rim && at.x < high.x + rim && at.y > low.y - rim && at.y < high.y + rim;
    if (!inside) share += one.share;
  }
  return share;
}

}  // namespace

MapVerdict map_verdict(const MapLikelihood& likelihood,
                       const MapPosterior& posterior,
                       const MapVerdictConfig& config) {
  MapVerdict out;
  out.found = posterior.log_evidence > config.evidence_min && posterior.gain > config.gain_min;
  for (const PlaceData& place : likelihood.places()) {
    const double expected = place.samples + config.curve_share * config.curve_share * place.force;
    const double off = (place.misfit - expected) / std::sqrt(2 * std::max(place.samples, 1.0));
    out.worst_curve = std::max(out.worst_curve, off);
  }
  const auto rest = likelihood.rest(out.found ? &posterior.best : nullptr);
  for (const double one : rest.deviations) {
    out.worst_deviation = std::max(out.worst_deviation, std::abs(one));
  }
  if (out.worst_curve > config.curve_max) out.doubts.push_back(MapDoubt::Curve);
  // Where hardly any ball explains the places, the few that do so least badly are no posterior.
  const bool starved = out.found && posterior.balls_worth < config.worth_min;
  if (out.worst_deviation > config.deviation_max || starved) {
    out.doubts.push_back(MapDoubt::NotOneBall);
  }
  if (!out.found) return out;
  if (posterior.modes.size() > 1 && posterior.modes[1].share > config.side_min &&
      distance(posterior.modes[0].place, posterior.modes[1].place) > kApart) {
    out.doubts.push_back(MapDoubt::TwoSides);
  }
  if (share_outside(likelihood, posterior) > config.outside_max) {
    out.doubts.push_back(MapDoubt::Outside);
  }
  return out;
}

}  // namespace palp::depth
