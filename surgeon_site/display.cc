#include "surgeon_site/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/record/notes.h"

namespace palp::surgeon {
namespace {

std::string number(const char* before, double value, int decimals, const char* after) {
  std::array<char, 64> text{};
  const bool zero = std::abs(value) < 0.5 * std::pow(10, -decimals);  // not "-0.00"
  std::snprintf(text.data(), text.size(), "%s%.*f%s", before, decimals, zero ? 0 : value, after);
  return text.data();
}

double milliseconds(Duration span) noexcept { return seconds(span) * 1e3; }

std::string link_text(const link::LinkHealth& link) {
  if (link.state == LinkState::Down) return "no link";
  std::string text = number("rtt ", milliseconds(link.round_trip), 1, " ms");
  const std::uint64_t all = link.accepted + link.late + link.lost;
  const double lost =
      all == 0 ? 0 : static_cast<double>(link.lost) / static_cast<double>(all) * 100;
  text += number("  loss ", lost, 1, " %");
  if (link.state != LinkState::Live) text += number("  silent ", seconds(link.gap), 1, " s");
  return text;
}

std::string shown_depth(const link::DepthReport& depth) {
  if (depth.number == 0) return "depth -";
  const std::string hash = number(" (h ", depth.hash, 4, " N)");
  const std::string text = depth_text_of(depth);
  if (depth.verdict == DepthVerdict::None) return text + hash;
  return "depth " + text + (depth.verdict == DepthVerdict::Found ? hash : "");
}

std::string progress_text(const ScriptProgress& script) {
  constexpr int kWidth = 10;
  if (!script.scripted) return {};
  const int filled = static_cast<int>(std::clamp(script.done, 0.0, 1.0) * kWidth);
  std::string text = "  [";
  for (int i = 0; i < kWidth; ++i) text += i < filled ? '#' : '-';
  text += number("] ", script.done * 100, 0, " %  ");
  if (script.finished) return text + std::string{to_string(script.outcome)};
  return text + script.phase_name.data();
}

/// What the operator should know about the state, where it is not the usual one.
std::string cue(const SurgeonStatus& status) {
  switch (status.state) {
    case SiteState::Hold:
    case SiteState::Retract:
    case SiteState::Stopped:
      return " (" + std::string{record::to_string(status.reason)} + ")";
    case SiteState::Clutched:
      if (status.refused == record::NoteCode::None) return {};
      return " (" + std::string{record::to_string(status.refused)} + ")";
    case SiteState::Parked:
    case SiteState::Engaged:
      break;
  }
  return {};
}

}  // namespace

std::string status_line(const SurgeonStatus& status) {
  return std::string{to_string(status.state)} + cue(status) + "  " + link_text(status.link) +
         number("  force ", status.force, 2, " N  ") + shown_depth(status.depth) +
         progress_text(status.script);
}

std::optional<std::string> delay_advice(const SurgeonStatus& status,
                                        Duration round_trip_max,
                                        bool engagement_forced) {
  const link::LinkHealth& link = status.link;
  if (link.state != LinkState::Live || link.round_trip <= round_trip_max) return std::nullopt;
  return number("the round trip is ", milliseconds(link.round_trip), 1, " ms: ") +
         number("above ", milliseconds(round_trip_max), 0, " ms ") +
         "coupling direct is not stable, tissue feels too soft or too stiff and a light hand is "
         "shaken; it " +
         (engagement_forced ? "engages here because --force-engage was given"
                            : "does not engage here unless --force-engage is given");
}

}  // namespace palp::surgeon
