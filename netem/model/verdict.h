#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace palp::netem {

/// OverLimit: no room on the way or in the queue, dropped by CoDel, longer than the MTU or than
/// link::kDatagramSizeMax. HeaderHit: the flipped bit lay in the headers, so that no socket would
/// have got the datagram.
enum class Verdict : std::uint8_t { Delivered, Lost, HeaderHit, OverLimit, Blackout };
inline constexpr std::size_t kVerdictCount = 5;

/// As recordings spell them.
inline constexpr std::array<std::string_view, kVerdictCount> kVerdictNames{
    "delivered", "lost", "header_hit", "over_limit", "blackout"};

}  // namespace palp::netem
