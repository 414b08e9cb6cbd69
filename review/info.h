#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palp::review {

/// Several lines for people: duration, topics with counts and rates, drops, closed or not.
[[nodiscard]] std::string describe(std::span<const std::byte> file);

}  // namespace palp::review
