#include "review/taps.h"

#include <algorithm>
#include <map>
#include <utility>

#include "common/core/median.h"
#include "common/core/place_text.h"
#include "common/message/map_text.h"
#include "judge/depth_summary.h"
#include "judge/stroke_pairing.h"
#include "review/text.h"

namespace palp::review {
namespace {

/// What a telegram takes from the surgeon's to the patient's site, mostly; bounded, for a file may
/// say anything.
Duration way_out(const SiteData& surgeon) {
  std::vector<double> ways;
  for (const LinkPoint& point : surgeon.links) {
    if (point.round_trip <= Duration{0}) continue;
    ways.push_back(seconds(point.delay_out > Duration{0} ? point.delay_out : point.round_trip / 2));
  }
  return from_seconds(std::clamp(median(ways).value_or(0), 0.0, 10.0));
}

/// An estimate's stroke as the hand made it, on the surgeon's line of time.
judge::Stay at_hand(const DepthEstimate& estimate, const TimeLine& line, Duration way) {
  return {TimePoint{elapsed(TimePoint{way}, line.surgeons(estimate.stroke_began_at))},
          TimePoint{elapsed(TimePoint{way}, line.surgeons(estimate.stroke_ended_at))},
          estimate.place};
}

/// The surgeon's excursions.
class Strokes {
 public:
  Strokes(const SiteData& surgeon, const TimeLine& line, std::vector<judge::Excursion> strokes)
      : line_{line}, way_{way_out(surgeon)}, strokes_{std::move(strokes)} {
    for (const DepthArrived& arrived : surgeon.reports) {
      arrived_at_.try_emplace(arrived.report.number, arrived.at);
    }
    std::ranges::stable_sort(strokes_, {}, &judge::Excursion::began_at);
    stays_.reserve(strokes_.size());
    for (const judge::Excursion& stroke : strokes_) {
      stays_.push_back({stroke.began_at, stroke.ended_at, stroke.place});
    }
  }

  /// The one an estimate came from.
  [[nodiscard]] std::optional<std::size_t> of(const DepthEstimate& estimate) const {
    return line_.known ? by_time(estimate) : by_arrival(estimate);
  }
  [[nodiscard]] const judge::Excursion& operator[](std::size_t index) const {
    return strokes_[index];
  }

 private:
  /// How many the surgeon began before.
  [[nodiscard]] std::size_t begun_before(TimePoint at) const {
    const auto later =
        std::partition_point(strokes_.begin(), strokes_.end(), [at](const auto& stroke) {
          return stroke.began_at < at;
        });
    return static_cast<std::size_t>(later - strokes_.begin());
  }

  [[nodiscard]] std::optional<std::size_t> by_time(const DepthEstimate& estimate) const {
    return judge::partner_of(at_hand(estimate, line_, way_), stays_);
  }

  /// Without knowing how the clocks lie: the last one that the surgeon began before the estimate
  /// arrived, for it leaves at the stroke's reversal, long before the next stroke begins.
  [[nodiscard]] std::optional<std::size_t> by_arrival(const DepthEstimate& estimate) const {
    const auto arrived = arrived_at_.find(estimate.number);
    if (arrived == arrived_at_.end()) {
      return std::nullopt;
    }
    const std::size_t later = begun_before(arrived->second);
    if (later == 0 || distance(strokes_[later - 1].place, estimate.place) > kSamePlace) {
      return std::nullopt;
    }
    return later - 1;
  }

  TimeLine line_;
  Duration way_;                                   ///< from the hand to the tip
  std::map<std::uint32_t, TimePoint> arrived_at_;  ///< by the estimate's number
  std::vector<judge::Excursion> strokes_;          ///< in order of time
  std::vector<judge::Stay> stays_;                 ///< the same
};

/// On the surgeon's line.
TimePoint beginning_of(const DepthEstimate& estimate,
                       const Strokes& strokes,
                       const std::optional<std::size_t>& stroke,
                       const TimeLine& line) {
  return stroke ? strokes[*stroke].contact_at : line.surgeons(estimate.stroke_began_at);
}

std::string cell(const std::optional<double>& value, int digits, std::size_t width) {
  return right(value ? fixed(*value, digits) : "-", width);
}

std::string stiffness_cells(const judge::FeltStiffness& stiffness) {
  const std::optional<double> error = stiffness.error();
  return cell(stiffness.felt(), 1, 16) + cell(stiffness.truth(), 1, 8) +
         cell(error ? std::optional{*error * 100} : std::nullopt, 1, 8);
}

std::string tap_row(const Tap& tap) {
  const DepthEstimate& estimate = tap.estimate;
  const judge::DepthStatement statement = judge::statement_of(estimate);
  const auto millimetres = [](const std::optional<double>& value) {
    return value ? std::optional{*value * 1e3} : std::nullopt;
  };
  std::string row = left(place_text(tap.place), 10) + ' ' +
                    left(std::string{to_string(tap.kind)} + ' ' + std::to_string(tap.index), 10) +
                    cell(estimate.indentation_max * 1e3, 2, 11) + cell(estimate.force_max, 3, 11) +
                    stiffness_cells(tap.stiffness) + cell(estimate.hash, 4, 8) + "  " +
                    left(std::string{to_string(estimate.verdict)}, 7) +
                    cell(millimetres(statement.depth), 2, 7);
  if (statement.low && statement.high) {
    row += "  " + fixed(*statement.low * 1e3, 1) + " to " + fixed(*statement.high * 1e3, 1);
  }
  const std::string reason{to_string(estimate.reason)};
  return row + (reason.empty() ? "" : "  (" + reason + ')') + '\n';
}

std::string touch_row(const judge::Excursion& touch) {
  return left(place_text(touch.place), 10) + ' ' + left("touch", 10) +
         cell(touch.indentation_max * 1e3, 2, 11) + cell(std::nullopt, 0, 11) +
         stiffness_cells(touch.stiffness) + cell(std::nullopt, 0, 8) + "  no estimate came of it\n";
}

}  // namespace

Touches match_taps(const SiteData& surgeon,
                   const SiteData& patient,
                   const TimeLine& line,
                   const std::vector<judge::Excursion>& excursions) {
  const Strokes strokes{surgeon, line, excursions};
  std::vector<bool> told(excursions.size());
  Touches touches;
  std::vector<Tap>& taps = touches.taps;
  for (const DepthEstimate& estimate : patient.estimates) {
    const auto stroke = strokes.of(estimate);
    const Duration span = stroke ? elapsed(strokes[*stroke].began_at, strokes[*stroke].ended_at)
                                 : elapsed(estimate.stroke_began_at, estimate.stroke_ended_at);
    Tap tap{.place = estimate.place,
            .kind = span > kTapMax ? StrokeKind::Press : StrokeKind::Tap,
            .index = 0,
            .began_at = beginning_of(estimate, strokes, stroke, line),
            .estimate = estimate,
            .stiffness = {}};
    tap.index = 1 + static_cast<int>(std::count_if(taps.begin(), taps.end(), [&](const Tap& other) {
                  return other.kind == tap.kind && distance(other.place, tap.place) <= kSamePlace;
                }));
    if (stroke) {
      told[*stroke] = true;
      tap.stiffness = strokes[*stroke].stiffness;
    }
    taps.push_back(tap);
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!told[i]) touches.others.push_back(strokes[i]);
  }
  return touches;
}

void take_truth(std::vector<Tap>& taps,
                const SessionPair& session,
                TimePoint run_began,
                const std::vector<judge::TapMetrics>& judged) {
  std::vector<judge::Stay> stays;
  stays.reserve(judged.size());
  for (const judge::TapMetrics& tap : judged) {
    stays.push_back({run_began + from_seconds(tap.began_at),
                     run_began + from_seconds(tap.ended_at),
                     tap.place});
  }
  const Duration way = way_out(session.surgeon);
  for (Tap& tap : taps) {
    const auto partner = judge::partner_of(at_hand(tap.estimate, session.time_line, way), stays);
    if (partner) tap.stiffness = judged[*partner].stiffness;
  }
}

std::optional<judge::DepthStatement> overall_depth(const std::vector<Tap>& taps) {
  std::vector<DepthEstimate> over;
  for (const Tap& tap : taps) {
    if (site_at(tap.place) == Site::B) {
      over.push_back(tap.estimate);
    }
  }
  if (over.empty()) {
    return std::nullopt;
  }
  return judge::statement_of(judge::summarise_depths(over));
}

std::string tap_table(TimePoint began_at,
                      const Touches& touches,
                      const std::optional<judge::DepthStatement>& depth,
                      const MapReport& map) {
  std::string text{
      "    time  place      stroke    indentation  force max  stiffness felt    true   error      "
      "h  verdict  depth  95 % interval\n"
      "       s                                mm          N             N/m     N/m       %      "
      "N          mm, right below the tip\n"};
  std::vector<std::pair<TimePoint, std::string>> rows;
  for (const Tap& tap : touches.taps) rows.emplace_back(tap.began_at, tap_row(tap));
  for (const judge::Excursion& touch : touches.others) {
    rows.emplace_back(touch.contact_at, touch_row(touch));
  }
  std::ranges::stable_sort(rows, {}, &std::pair<TimePoint, std::string>::first);
  for (const auto& [at, row] : rows) {
    text += right(fixed(seconds(elapsed(began_at, at)), 2), 8) + "  " + row;
  }
  if (rows.empty()) {
    text += "no stroke\n";
  }
  if (map.number != 0) return text + "all places together: " + map_sentence(map) + '\n';
  text += "over the inclusion: ";
  if (!depth) return text + "no tap\n";
  if (!depth->depth) return text + depth->says + '\n';
  text += "found, top of the inclusion " + fixed(*depth->depth * 1e3, 1) + " mm below the surface";
  if (depth->low && depth->high) {
    text += ", between " + fixed(*depth->low * 1e3, 1) + " and " + fixed(*depth->high * 1e3, 1);
  }
  return text + '\n';
}

}  // namespace palp::review
