#include "surgeon_site/display.h"

#include <algorithm>

#include "common/core/depth_text.h"
#include "common/core/number_text.h"
#include "common/core/place_text.h"
#include "common/link/health_text.h"
#include "common/record/notes.h"

namespace palp::surgeon {
namespace {

double in_milliseconds(Duration span) noexcept { return seconds(span) * 1e3; }

std::string progress_text(const ScriptProgress& script) {
  constexpr int kWidth = 10;
  if (!script.scripted) return {};
  const int filled = static_cast<int>(std::clamp(script.done, 0.0, 1.0) * kWidth);
  std::string text = "  [";
  for (int i = 0; i < kWidth; ++i) text += i < filled ? '#' : '-';
  text += number_text("] ", script.done * 100, 0, " %  ");
  if (script.finished) return text + std::string{to_string(script.outcome)};
  return text + script.phase_name.data();
}

/// A stage that goes along with the hand is no news.
std::string stage_text(const SurgeonStatus& status) {
  const bool apart = distance(status.place, status.peer_place) > kSamePlace;
  if (status.state != SiteState::Engaged || !status.peer_heard || !apart) return {};
  return "stage not at " + place_text(status.place) + " but at " + place_text(status.peer_place) +
         "  ";
}

std::string incomplete_text(const SurgeonStatus& status) {
  if (!status.force_incomplete) return {};
  return number_text("LESS THAN THE TISSUE'S BY ", status.force_missing, 2, " N: lift once  ");
}

}  // namespace

std::string status_line(const SurgeonStatus& status) {
  return record::state_text(status.state, status.reason, status.refused) + "  " +
         link::health_text(status.link) + number_text("  force ", status.force, 2, " N  ") +
         incomplete_text(status) + stage_text(status) + depth_line_of(status.depth) +
         progress_text(status.script);
}

std::optional<std::string> delay_advice(const SurgeonStatus& status,
                                        Duration round_trip_max,
                                        bool engagement_forced) {
  const LinkHealth& link = status.link;
  if (link.state != LinkState::Live || link.round_trip <= round_trip_max) return std::nullopt;
  return number_text("the round trip is ", in_milliseconds(link.round_trip), 1, " ms: ") +
         number_text("above ", in_milliseconds(round_trip_max), 0, " ms ") +
         "coupling direct is not stable, tissue feels too soft or too stiff and a light hand is "
         "shaken; it " +
         (engagement_forced ? "engages here because --force-engage was given"
                            : "does not engage here unless --force-engage is given");
}

}  // namespace palp::surgeon
