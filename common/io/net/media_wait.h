#pragma once

#include <cstdint>

#include "common/core/time.h"

namespace palp::io {

/// TOS byte of DSCP AF41 (RFC 2597), which is what video over a wide area asks for (RFC 4594).
inline constexpr std::uint8_t kAssuredForwarding = 34 << 2;

/// Until a datagram has come for that socket, or `span` is over; -1: only that.
void wait_for_datagram(int socket, Duration span) noexcept;

}  // namespace palp::io
