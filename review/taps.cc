#include "review/taps.h"

#include <algorithm>
#include <map>

#include "review/text.h"

namespace palp::review {
namespace {

const Excursion* most_overlapping(const std::vector<Excursion>& excursions,
                                  TimePoint began_at,
                                  TimePoint ended_at) {
  const Excursion* best = nullptr;
  Duration overlap_max{0};
  for (const Excursion& excursion : excursions) {
    const Duration overlap =
        std::min(excursion.ended_at, ended_at) - std::max(excursion.began_at, began_at);
    if (overlap > overlap_max) {
      overlap_max = overlap;
      best = &excursion;
    }
  }
  return best;
}

const Excursion* nth_at(const std::vector<Excursion>& excursions, Place place, int n) {
  for (const Excursion& excursion : excursions) {
    if (excursion.place == place && --n == 0) {
      return &excursion;
    }
  }
  return nullptr;
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

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<Tap> match_taps(const SiteData& surgeon,
                            const SiteData& patient,
                            const TissueTable* tissue) {
  const double surface = surface_of(patient);
  const auto excursions = find_excursions(surgeon.motion, surface);
  const auto delay = patient.stamp_difference_min;  // clock offset and way, both in one
  std::map<std::pair<Place, StrokeKind>, int> counts;
  std::map<Place, int> deep;
  std::vector<Tap> taps;
  for (const DepthEstimate& estimate : patient.estimates) {
    const bool press = estimate.stroke_ended_at - estimate.stroke_began_at > kTapMax;
    Tap tap{.place = place_at(estimate.lateral),
            .kind = press ? StrokeKind::Press : StrokeKind::Tap,
            .index = 0,
            .estimate = estimate,
            .stiffness = {}};
    tap.index = ++counts[{tap.place, tap.kind}];
    const Excursion* excursion = nullptr;
    if (delay) {
      excursion = most_overlapping(
          excursions, estimate.stroke_began_at - *delay, estimate.stroke_ended_at - *delay);
    } else if (estimate.indentation_max > kStrokeDepthMin) {
      excursion = nth_at(excursions, tap.place, ++deep[tap.place]);
    }
    if (excursion != nullptr && excursion->place == tap.place) {
      tap.stiffness = fit_stiffness(*excursion, surface, tissue);
    }
    taps.push_back(tap);
  }
  return taps;
}

OverallDepth judge_depth(const std::vector<Tap>& taps) {
  std::map<DepthVerdict, std::size_t> verdicts;
  std::size_t count = 0;
  std::vector<double> depths;
  std::vector<double> lows;
  std::vector<double> highs;
  for (const Tap& tap : taps) {
    if (tap.place != Place::B || tap.kind != StrokeKind::Tap) {
      continue;
    }
    ++count;
    ++verdicts[tap.estimate.verdict];
    if (tap.estimate.verdict == DepthVerdict::Found) {
      depths.push_back(tap.estimate.depth);
    }
    if (has_interval(tap.estimate)) {
      lows.push_back(tap.estimate.depth_low);
      highs.push_back(tap.estimate.depth_high);
    }
  }
  OverallDepth overall;
  if (count == 0) {
    return overall;
  }
  overall.verdict = DepthVerdict::Invalid;
  if (2 * verdicts[DepthVerdict::None] > count) {
    overall.verdict = DepthVerdict::None;
  } else if (2 * verdicts[DepthVerdict::Found] > count) {
    overall = {.verdict = DepthVerdict::Found,
               .depth = median(depths),
               .low = median(lows),
               .high = median(highs)};
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
