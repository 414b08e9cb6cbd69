#include "depth/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/core/conventions.h"

namespace palp::depth {
namespace {

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

std::string_view reason_of(MapDoubt doubt) noexcept {
  switch (doubt) {
    case MapDoubt::Curve:
      return "the force at a place grows as in no tissue that was assumed";
    case MapDoubt::NotOneBall:
      return "one ball does not explain the stiffness at every place";
    case MapDoubt::TwoSides:
      return "the inclusion may lie at either of two places";
    case MapDoubt::Outside:
      return "the inclusion may lie beyond the touched places";
  }
  return "?";
}

std::string_view remedy_of(MapDoubt doubt) noexcept {
  switch (doubt) {
    case MapDoubt::Curve:
      return "tap slower and check the sensor's pole";
    case MapDoubt::NotOneBall:
      return "touch between the places that differ";
    case MapDoubt::TwoSides:
      return "touch beside the line of the touches";
    case MapDoubt::Outside:
      return "touch farther out on the stiff side";
  }
  return "?";
}

MapVerdict map_verdict(const MapLikelihood& likelihood,
                       const MapPosterior& posterior,
                       const MapVerdictConfig& config) {
  MapVerdict out;
  out.found = posterior.log_evidence > config.evidence_min && posterior.gain > config.gain_min;
  for (const PlaceData& place : likelihood.places()) {
    const double off = (place.misfit - place.samples) / std::sqrt(2 * std::max(place.samples, 1.0));
    out.worst_curve = std::max(out.worst_curve, off);
  }
  const auto rest = likelihood.rest(out.found ? &posterior.best : nullptr);
  for (const double one : rest.deviations) {
    out.worst_deviation = std::max(out.worst_deviation, std::abs(one));
  }
  if (out.worst_curve > config.curve_max) out.doubts.push_back(MapDoubt::Curve);
  if (out.worst_deviation > config.deviation_max) out.doubts.push_back(MapDoubt::NotOneBall);
  if (!out.found) return out;
  if (posterior.modes.size() > 1 && posterior.modes[1].share > config.side_min) {
    out.doubts.push_back(MapDoubt::TwoSides);
  }
  if (share_outside(likelihood, posterior) > config.outside_max) {
    out.doubts.push_back(MapDoubt::Outside);
  }
  return out;
}

std::string map_sentence(const MapPosterior& posterior, const MapVerdict& verdict) {
  std::string text;
  char words[320];
  if (verdict.found) {
    const auto mm = [](double metres) { return metres / kMillimetre; };
    std::snprintf(words,
                  sizeof words,
                  "One round inclusion, if the tissue is otherwise even: at x %.1f mm (%.1f to "
                  "%.1f), y %.1f mm (%.1f to %.1f), its top %.1f mm deep (%.1f to %.1f), radius "
                  "%.1f mm (%.1f to %.1f).",
                  mm(posterior.x.median),
                  mm(posterior.x.low),
                  mm(posterior.x.high),
                  mm(posterior.y.median),
                  mm(posterior.y.low),
                  mm(posterior.y.high),
                  mm(posterior.depth.median),
                  mm(posterior.depth.low),
                  mm(posterior.depth.high),
                  mm(posterior.radius.median),
                  mm(posterior.radius.low),
                  mm(posterior.radius.high));
    text = words;
  } else {
    text = "No inclusion found.";
  }
  for (const MapDoubt doubt : verdict.doubts) {
    text.append(" Not trusted: ").append(reason_of(doubt)).append("; ");
    text.append(remedy_of(doubt)).append(".");
  }
  return text;
}

}  // namespace palp::depth
