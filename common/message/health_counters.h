#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "common/message/link_health.h"

namespace palp::message {

using Counters = std::vector<std::pair<std::string_view, std::uint64_t>>;

/// Datagrams that were of no use, by the reason: "malformed", ...
[[nodiscard]] Counters refusals_of(const LinkHealth& health);
/// What else the link counts: "sent", ...
[[nodiscard]] Counters counters_of(const LinkHealth& health);

}  // namespace palp::message
