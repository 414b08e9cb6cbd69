#pragma once

#include <cstdint>
#include <vector>

#include "common/record/session_encoder.h"
#include "monitor/controls.h"
#include "monitor/protocol.h"

/// What a site offers to clients, by number. Pure.
namespace palp::monitor {

inline constexpr std::uint32_t kStatusChannel = 100;
inline constexpr std::uint32_t kClientChannel = 101;
inline constexpr std::uint32_t kCameraChannel = 102;
inline constexpr std::uint32_t kJpegChannel = 103;
inline constexpr std::uint32_t kVideoChannel = 104;
inline constexpr std::uint32_t kStudyChannel = 105;
/// Of a topic of the session file.
[[nodiscard]] constexpr std::uint32_t channel_id(record::Topic topic) noexcept {
  return static_cast<std::uint32_t>(topic) + 1;
}

// Numbers of services.
inline constexpr std::uint32_t kMark = 1;
inline constexpr std::uint32_t kStop = 2;
inline constexpr std::uint32_t kReset = 3;
inline constexpr std::uint32_t kEnd = 4;
inline constexpr std::uint32_t kTake = 5;
inline constexpr std::uint32_t kGive = 6;
inline constexpr std::uint32_t kAnswer = 7;

/// To look at. Of a camera and a study only where there is one.
[[nodiscard]] std::vector<Channel> channels_of(link::Role site, const Controls& controls);
/// To ask for. None where nothing may be asked.
[[nodiscard]] std::vector<Service> services_of(const Controls& controls);

}  // namespace palp::monitor
