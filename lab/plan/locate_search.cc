#include "lab/plan/locate_search.h"

#include <algorithm>

#include "depth/map_posterior.h"
#include "depth/map_verdict.h"
#include "depth/next_touch.h"
#include "lab/plan/stiffness_process.h"
#include "surgeon_site/script_builder.h"

namespace palp::lab {
namespace {

constexpr double kNear = 1e-3;         // [m]
constexpr double kRasterPitch = 8e-3;  // [m]
constexpr int kRasterSide = 7;         // taps
constexpr double kTrust = 2;           // [-], standard deviations of UCB

/// To and fro, from a corner.
Place raster_place(std::uint32_t tap) {
  const int row = static_cast<int>(tap) / kRasterSide;
  const int along = static_cast<int>(tap) % kRasterSide;
  const int column = row % 2 == 0 ? along : kRasterSide - 1 - along;
  const double middle = 0.5 * (kRasterSide - 1);
  return {(column - middle) * kRasterPitch, (row - middle) * kRasterPitch};
}

StiffnessProcess process_of(const std::vector<depth::PlaceData>& places) {
  std::vector<StiffnessReading> readings;
  readings.reserve(places.size());
  for (const depth::PlaceData& one : places) readings.push_back(stiffness_reading(one));
  return StiffnessProcess::fitted(readings);
}

}  // namespace

void Searched::judge(bool is_known, bool is_near) noexcept {
  if (is_known && known == 0) known = touches;
  if (!is_near) near = 0;
  if (is_near && near == 0) near = touches;
}

Searched search_field(TapRule rule,
                      const SearchParts& parts,
                      Palpation& hand,
                      const std::optional<Place>& axis,
                      std::vector<depth::PlaceData>& places) {
  Searched out;
  std::optional<Place> proposed;
  while (out.touches < kFieldTaps) {
    Place at = proposed.value_or(surgeon::kSearchFirst[out.touches % surgeon::kSearchFirst.size()]);
    if (rule == TapRule::Raster) at = raster_place(out.touches);
    const auto felt = hand.touch(at);
    ++out.touches;
    if (felt) {
      std::erase_if(places, [&](const depth::PlaceData& one) { return one.place == felt->place; });
      places.push_back(*felt);
    }
    if (places.size() < depth::kMapPlacesMin) continue;
    const depth::MapLikelihood likelihood{parts.field, parts.tissue, places};
    const auto posterior = depth::map_posterior(likelihood, parts.field, parts.prior);
    const auto verdict = depth::map_verdict(likelihood, posterior, parts.config.verdict);
    const auto next = depth::next_touch(likelihood, parts.field, posterior, parts.config.travel);
    const MapStop stop = depth::map_stop(posterior, verdict, next, parts.config);
    Place said{posterior.x.median, posterior.y.median};
    if (rule == TapRule::Gp) {
      const StiffnessProcess process = process_of(places);
      said = stiffest_place(process, kFieldHalf, 0);
      proposed = stiffest_place(process, kFieldHalf, kTrust);
    } else if (next) {
      proposed = next->place;
    }
    const bool near =
        axis && (verdict.found || rule == TapRule::Gp) && distance(said, *axis) <= kNear;
    out.judge(stop == MapStop::Known, near);
    // The process has no rule of its own to end by.
    if (rule != TapRule::Gp && stop == MapStop::Known) break;
    if (rule == TapRule::Search && stop != MapStop::GoOn) break;
  }
  return out;
}

}  // namespace palp::lab
