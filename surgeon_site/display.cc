#include "surgeon_site/display.h"

#include <algorithm>
#include <array>

#include "common/core/depth_text.h"
#include "common/core/fitted_line.h"
#include "common/core/number_text.h"
#include "common/core/place_text.h"
#include "common/link/health_text.h"
#include "common/message/map_text.h"
#include "common/record/notes.h"

namespace palp::surgeon {
namespace {

LinePart bar_of(const ScriptProgress& script) {
  constexpr int kWidth = 10;
  if (!script.scripted) return {};
  const int filled = static_cast<int>(std::clamp(script.done, 0.0, 1.0) * kWidth);
  std::string bar = "[";
  for (int i = 0; i < kWidth; ++i) bar += i < filled ? '#' : '-';
  const std::string share = number_text("", script.done * 100, 0, " %");
  return {.full = bar + "] " + share, .brief = share, .rank = 5};
}

std::string phase_text(const ScriptProgress& script) {
  if (!script.scripted) return {};
  return script.finished ? std::string{to_string(script.outcome)} : script.phase_name.data();
}

/// A stage that goes along with the hand is no news.
std::string stage_text(const SurgeonStatus& status) {
  const bool apart = distance(status.place, status.peer_place) > kSamePlace;
  if (status.state != SiteState::Engaged || !status.peer_heard || !apart) return {};
  return "stage not at " + place_text(status.place) + " but at " + place_text(status.peer_place);
}

/// Touches at several places say more than the last one alone.
LinePart found_part(const SurgeonStatus& status) {
  if (status.map.number != 0) {
    return {.full = map_line(status.map), .brief = map_brief(status.map), .rank = 2};
  }
  return {.full = depth_line_of(status.depth), .brief = depth_brief_of(status.depth), .rank = 2};
}

/// `before` and `after` an amount.
LinePart short_part(const SurgeonStatus& status, const char* before, const char* after) {
  return {.full = number_text(before, status.short_by, 2, after),
          .brief = number_text("LESS BY ", status.short_by, 2, " N"),
          .rank = 6};
}

/// What helps, where something does.
LinePart incomplete_part(const SurgeonStatus& status) {
  switch (status.shortage) {
    case record::NoteCode::None:
      return {};
    case record::NoteCode::TissueTooStiff:
      return short_part(
          status, "LESS THAN THE TISSUE'S BY ", " N: it is stiffer than can be shown");
    case record::NoteCode::TipFeelsMore:
      return short_part(status, "THE TIP FEELS ", " N MORE THAN YOU");
    case record::NoteCode::TipElsewhere: {
      const double behind = distance(status.place, status.peer_place) * 1e3;
      return {.full = number_text("YOU FEEL ANOTHER PLACE: the tip is ", behind, 0, " mm behind"),
              .brief = number_text("TIP ", behind, 0, " mm BEHIND"),
              .rank = 6};
    }
    default:
      return short_part(status, "LESS THAN THE TISSUE'S BY ", " N: lift once");
  }
}

}  // namespace

std::string status_line(const SurgeonStatus& status, std::size_t columns) {
  std::array<LinePart, 8> parts{
      {{.full = record::state_text(status.state, status.reason, status.refused),
        .brief = std::string{to_string(status.state)},
        .rank = 4},
       {.full = link::health_text(status.link),
        .brief = link::health_brief(status.link),
        .rank = 1},
       {.full = number_text("force ", status.force, 2, " N"),
        .brief = number_text("force ", status.force, 2, " N"),
        .rank = 7},
       incomplete_part(status),
       {.full = stage_text(status), .brief = {}, .rank = 3},
       found_part(status),
       bar_of(status.script),
       {.full = phase_text(status.script), .brief = {}, .rank = 3}}};
  return fitted_line(parts, columns);
}

}  // namespace palp::surgeon
