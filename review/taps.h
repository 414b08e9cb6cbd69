#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/place.h"
#include "judge/depth_statement.h"
#include "judge/excursions.h"
#include "judge/felt_stiffness.h"
#include "judge/metrics.h"
#include "review/site_data.h"
#include "review/time_line.h"

namespace palp::review {

enum class StrokeKind : std::uint8_t { Tap, Press };
inline constexpr Duration kTapMax{std::chrono::milliseconds{1500}};  ///< longer is a press

[[nodiscard]] constexpr const char* to_string(StrokeKind kind) noexcept {
  return kind == StrokeKind::Tap ? "tap" : "press";
}

/// One stroke as both sites saw it.
struct Tap {
  Place place;
  StrokeKind kind{};
  int index{};           ///< 1, 2, ... among the strokes of its kind at its site
  TimePoint began_at{};  ///< surgeon's time: the hand's contact, where it is known, else the tip's
  DepthEstimate estimate;
  judge::FeltStiffness stiffness;  ///< empty: nobody knows what was felt
};

/// All that the hand did in the tissue.
struct Touches {
  std::vector<Tap> taps;  ///< those of an estimate, in the order of these
  /// Those that no estimate came of: sideways touches, a press that the session's end cut off, what
  /// the patient's site never saw. In order of time.
  std::vector<judge::Excursion> others;
};

/// The strokes of the patient's file with what the surgeon felt in them: a stroke belongs to the
/// excursion of the hand at its place that shares most time with it; where nobody knows how the
/// clocks lie, to the last one that began before its estimate arrived at the surgeon's.
[[nodiscard]] Touches match_taps(const SiteData& surgeon,
                                 const SiteData& patient,
                                 const TimeLine& line,
                                 const std::vector<judge::Excursion>& excursions);

/// Gives each tap what was true of it, where a judge of the simulation said so: `judged` with times
/// since `run_began`, the surgeon's.
void take_truth(std::vector<Tap>& taps,
                const SessionPair& session,
                TimePoint run_began,
                const std::vector<judge::TapMetrics>& judged);

/// What all strokes over the inclusion say together, as the lab has it; nullopt: there is none.
[[nodiscard]] std::optional<judge::DepthStatement> overall_depth(const std::vector<Tap>& taps);

/// For people, one line each in order of time, since `began_at` of the session, and last what the
/// touches say together: `map`, where they were at several places, else `depth`.
[[nodiscard]] std::string tap_table(TimePoint began_at,
                                    const Touches& touches,
                                    const std::optional<judge::DepthStatement>& depth,
                                    const MapReport& map);

}  // namespace palp::review
