#pragma once

#include <cstddef>
#include <cstdint>

#include "common/core/time.h"

namespace palp::io {

/// Marks of every datagram of video (WIRE.md): version 8, type 5.
inline constexpr std::byte kMediaFirstByte{0x85};

/// TOS byte of DSCP AF41 (RFC 2597), which is what video over a wide area asks for (RFC 4594).
inline constexpr std::uint8_t kAssuredForwarding = 34 << 2;

/// Until a datagram has come for that socket, or `span` is over; -1: only that.
void wait_for_datagram(int socket, Duration span) noexcept;

}  // namespace palp::io
