#pragma once

#include <cstdint>
#include <string_view>

namespace palp {

/// The states both sites speak of; who moves them and when: common/link/STATES.md.
enum class SiteState : std::uint8_t { Parked, Clutched, Engaged, Hold, Retract, Stopped };
inline constexpr int kSiteStateCount = 6;

[[nodiscard]] constexpr std::string_view to_string(SiteState state) noexcept {
  switch (state) {
    case SiteState::Parked:
      return "PARKED";
    case SiteState::Clutched:
      return "CLUTCHED";
    case SiteState::Engaged:
      return "ENGAGED";
    case SiteState::Hold:
      return "HOLD";
    case SiteState::Retract:
      return "RETRACT";
    case SiteState::Stopped:
      return "STOPPED";
  }
  return "?";
}

/// What the arrival gap says of the link (watchdog.h); Down: no session.
enum class LinkState : std::uint8_t { Down, Live, Hold, Lost };
inline constexpr int kLinkStateCount = 4;

[[nodiscard]] constexpr std::string_view to_string(LinkState state) noexcept {
  switch (state) {
    case LinkState::Down:
      return "DOWN";
    case LinkState::Live:
      return "LIVE";
    case LinkState::Hold:
      return "HOLD";
    case LinkState::Lost:
      return "LOST";
  }
  return "?";
}

}  // namespace palp
