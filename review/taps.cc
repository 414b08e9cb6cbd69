#include "review/taps.h"

#include <algorithm>
#include <map>

#include "common/core/median.h"
#include "patient_site/estimator/depth_summary.h"
#include "review/text.h"

namespace palp::review {
namespace {

/// The stroke an estimate came from: the last one that the surgeon began before the estimate
/// arrived. The clocks of the sites need not agree for that, and an estimate leaves at the stroke's
/// reversal, long before the next stroke begins.
const Excursion* excursion_of(const DepthEstimate& estimate,
                              const SiteData& surgeon,
                              const std::vector<Excursion>& excursions) {
  const auto report = std::find_if(
      surgeon.reports.begin(), surgeon.reports.end(), [&](const record::DepthArrived& arrived) {
        return arrived.report.number == estimate.number;
      });
  if (report == surgeon.reports.end()) {
    return nullptr;
  }
  const Excursion* last = nullptr;
  for (const Excursion& excursion : excursions) {
    if (excursion.began_at < report->at) {
      last = &excursion;
    }
  }
  return last != nullptr && last->place == place_at(estimate.lateral) ? last : nullptr;
}

double surface_of(const SiteData& patient) {
  if (const auto offset = patient.number("surface_offset_mm")) {
    return *offset * 1e-3;
  }
  std::vector<double> found;
  for (const DepthEstimate& estimate : patient.estimates) {
    if (estimate.reason != DepthReason::NoContact) {
      found.push_back(estimate.surface);
    }
  }
  return median(found).value_or(0);
}

std::string cell(const std::optional<double>& value, int digits, std::size_t width) {
  return right(value ? fixed(*value, digits) : "-", width);
}

}  // namespace

std::vector<Tap> match_taps(const SiteData& surgeon,
                            const SiteData& patient,
                            const TissueTable* tissue) {
  const double surface = surface_of(patient);
  const auto excursions = find_excursions(surgeon.motion, surface);
  std::map<std::pair<Place, StrokeKind>, int> counts;
  std::vector<Tap> taps;
  for (const DepthEstimate& estimate : patient.estimates) {
    const Excursion* excursion = excursion_of(estimate, surgeon, excursions);
    const Duration span = excursion != nullptr
                              ? elapsed(excursion->began_at, excursion->ended_at)
                              : elapsed(estimate.stroke_began_at, estimate.stroke_ended_at);
    Tap tap{.place = place_at(estimate.lateral),
            .kind = span > kTapMax ? StrokeKind::Press : StrokeKind::Tap,
            .index = 0,
            .estimate = estimate,
            .stiffness = {}};
    tap.index = ++counts[{tap.place, tap.kind}];
    if (excursion != nullptr) {
      tap.stiffness = fit_stiffness(*excursion, surface, tissue);
    }
    taps.push_back(tap);
  }
  return taps;
}

OverallDepth judge_depth(const std::vector<Tap>& taps) {
  std::vector<DepthEstimate> over;
  for (const Tap& tap : taps) {
    if (tap.place == Place::B && tap.kind == StrokeKind::Tap) {
      over.push_back(tap.estimate);
    }
  }
  if (over.empty()) {
    return {};
  }
  const DepthEstimate summary = estimator::summarise_depths(over);
  OverallDepth overall{.verdict = summary.verdict, .depth = {}, .low = {}, .high = {}};
  if (summary.verdict == DepthVerdict::Found) {
    overall.depth = summary.depth;
  }
  if (has_interval(summary)) {
    overall.low = summary.depth_low;
    overall.high = summary.depth_high;
  }
  return overall;
}

std::string tap_table(const std::vector<Tap>& taps, const OverallDepth& depth) {
  std::string text{
      "site  stroke    indentation  force max  stiffness felt    true   error      h  "
      "verdict  depth\n"
      "                         mm          N             N/m     N/m       %      N"
      "              mm\n"};
  for (const Tap& tap : taps) {
    const Stiffness& stiffness = tap.stiffness;
    std::optional<double> error;
    if (stiffness.felt && stiffness.truth && *stiffness.truth != 0) {
      error = 100 * (*stiffness.felt / *stiffness.truth - 1);
    }
    const DepthEstimate& estimate = tap.estimate;
    const bool found = estimate.verdict == DepthVerdict::Found;
    text += left(to_string(tap.place), 6) +
            left(std::string{to_string(tap.kind)} + ' ' + std::to_string(tap.index), 10) +
            cell(estimate.indentation_max * 1e3, 2, 11) + cell(estimate.force_max, 3, 11) +
            cell(stiffness.felt, 1, 16) + cell(stiffness.truth, 1, 8) + cell(error, 1, 8) +
            cell(estimate.hash, 4, 8) + "  " + left(std::string{to_string(estimate.verdict)}, 7) +
            cell(found ? std::optional{estimate.depth * 1e3} : std::nullopt, 2, 7);
    const std::string reason{to_string(estimate.reason)};
    text += (reason.empty() ? "" : "  (" + reason + ')') + '\n';
  }
  if (taps.empty()) {
    text += "no stroke\n";
  }
  text += "over the inclusion: ";
  text += depth.verdict ? std::string{to_string(*depth.verdict)} : "no tap";
  if (depth.depth) {
    text += ", top of the inclusion " + fixed(*depth.depth * 1e3, 2) + " mm below the surface";
  }
  return text + '\n';
}

}  // namespace palp::review
