#include "patient_site/display.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "common/core/conventions.h"
#include "common/core/depth_text.h"
#include "common/record/notes.h"

namespace palp::patient {
namespace {

std::string number(const char* before, double value, int decimals, const char* after) {
  std::array<char, 64> text{};
  const bool zero = std::abs(value) < 0.5 * std::pow(10, -decimals);  // not "-0.00"
  std::snprintf(text.data(), text.size(), "%s%.*f%s", before, decimals, zero ? 0 : value, after);
  return text.data();
}

std::string link_text(const link::LinkHealth& link) {
  if (link.state == LinkState::Down) return "no link";
  std::string text = number("rtt ", seconds(link.round_trip) * 1e3, 1, " ms");
  const std::uint64_t all = link.accepted + link.late + link.lost;
  const double lost =
      all == 0 ? 0 : static_cast<double>(link.lost) / static_cast<double>(all) * 100;
  text += number("  loss ", lost, 1, " %");
  if (link.state != LinkState::Live) text += number("  silent ", seconds(link.gap), 1, " s");
  return text;
}

std::string shown_depth(const DepthEstimate& depth) {
  if (depth.number == 0) return "depth -";
  const std::string hash = number(" (h ", depth.hash, 4, " N)");
  const std::string text = depth_text_of(depth);
  if (depth.verdict == DepthVerdict::None) return text + hash;
  return "depth " + text + (depth.verdict == DepthVerdict::Found ? hash : "");
}

/// What people should know about the state, where it is not the usual one.
std::string cue(const PatientStatus& status) {
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

std::string status_line(const PatientStatus& status) {
  return std::string{to_string(status.state)} + cue(status) + "  " + link_text(status.link) +
         number("  tip ", status.position / kMillimetre, 2, " mm") +
         number("  contact ", status.contact_force, 2, " N  ") + shown_depth(status.depth);
}

}  // namespace palp::patient
