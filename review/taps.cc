#include "review/taps.h"

#include <algorithm>
#include <map>

#include "common/core/depth_text.h"
#include "common/core/median.h"
#include "patient_site/estimator/depth_summary.h"
#include "review/text.h"

namespace palp::review {
namespace {

/// The surgeon's excursions, each with its stiffness once it was asked for.
class Strokes {
 public:
  Strokes(const SiteData& surgeon, double surface, const TissueTable* tissue)
      : surface_{surface}, tissue_{tissue} {
    for (const DepthArrived& arrived : surgeon.reports) {
      arrived_at_.try_emplace(arrived.report.number, arrived.at);
    }
    for (const Excursion& excursion : find_excursions(surgeon.motion, surface)) {
      strokes_.push_back({excursion, {}});
    }
    std::stable_sort(strokes_.begin(), strokes_.end(), [](const Stroke& a, const Stroke& b) {
      return a.excursion.began_at < b.excursion.began_at;
    });
  }

  /// The one an estimate came from: the last one that the surgeon began before the estimate
  /// arrived. The clocks of the sites need not agree for that, and an estimate leaves at the
  /// stroke's reversal, long before the next stroke begins.
  [[nodiscard]] std::optional<std::size_t> of(const DepthEstimate& estimate) const {
    const auto arrived = arrived_at_.find(estimate.number);
    if (arrived == arrived_at_.end()) {
      return std::nullopt;
    }
    const auto later = std::partition_point(
        strokes_.begin(), strokes_.end(), [at = arrived->second](const Stroke& stroke) {
          return stroke.excursion.began_at < at;
        });
    if (later == strokes_.begin() ||
        std::prev(later)->excursion.place != place_at(estimate.lateral)) {
      return std::nullopt;
    }
    return static_cast<std::size_t>(std::prev(later) - strokes_.begin());
  }
  [[nodiscard]] Duration span(std::size_t index) const {
    const Excursion& excursion = strokes_[index].excursion;
    return elapsed(excursion.began_at, excursion.ended_at);
  }
  [[nodiscard]] const Stiffness& stiffness(std::size_t index) {
    Stroke& stroke = strokes_[index];
    if (!stroke.stiffness) {
      stroke.stiffness = fit_stiffness(stroke.excursion, surface_, tissue_);
    }
    return *stroke.stiffness;
  }

 private:
  struct Stroke {
    Excursion excursion;
    std::optional<Stiffness> stiffness;
  };

  double surface_;  ///< [m]
  const TissueTable* tissue_;
  std::map<std::uint32_t, TimePoint> arrived_at_;  ///< by the estimate's number
  std::vector<Stroke> strokes_;                    ///< in order of time
};

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
  Strokes strokes{surgeon, surface_of(patient), tissue};
  std::map<std::pair<Place, StrokeKind>, int> counts;
  std::vector<Tap> taps;
  for (const DepthEstimate& estimate : patient.estimates) {
    const auto stroke = strokes.of(estimate);
    const Duration span = stroke ? strokes.span(*stroke)
                                 : elapsed(estimate.stroke_began_at, estimate.stroke_ended_at);
    Tap tap{.place = place_at(estimate.lateral),
            .kind = span > kTapMax ? StrokeKind::Press : StrokeKind::Tap,
            .index = 0,
            .estimate = estimate,
            .stiffness = {}};
    tap.index = ++counts[{tap.place, tap.kind}];
    if (stroke) {
      tap.stiffness = strokes.stiffness(*stroke);
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
  OverallDepth overall;
  overall.verdict = summary.verdict;
  overall.says = depth_text_of(summary);
  if (summary.verdict == DepthVerdict::Found) {
    overall.depth = summary.depth;
  }
  if (has_interval(summary)) {
    overall.low = summary.depth_low;
    overall.high = summary.depth_high;
  }
  if (summary.verdict == DepthVerdict::None && summary.depth_low > 0) {
    overall.excluded = summary.depth_low;
  }
  return overall;
}

std::string tap_table(const std::vector<Tap>& taps, const OverallDepth& depth) {
  std::string text{
      "site  stroke    indentation  force max  stiffness felt    true   error      h  "
      "verdict  depth  95 % interval\n"
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
    if (has_interval(estimate)) {
      text +=
          "  " + fixed(estimate.depth_low * 1e3, 1) + " to " + fixed(estimate.depth_high * 1e3, 1);
    }
    const std::string reason{to_string(estimate.reason)};
    text += (reason.empty() ? "" : "  (" + reason + ')') + '\n';
  }
  if (taps.empty()) {
    text += "no stroke\n";
  }
  text += "over the inclusion: ";
  if (!depth.verdict) return text + "no tap\n";
  if (!depth.depth) return text + depth.says + '\n';
  text += "found, top of the inclusion " + fixed(*depth.depth * 1e3, 1) + " mm below the surface";
  if (depth.low && depth.high) {
    text += ", between " + fixed(*depth.low * 1e3, 1) + " and " + fixed(*depth.high * 1e3, 1);
  }
  return text + '\n';
}

}  // namespace palp::review
