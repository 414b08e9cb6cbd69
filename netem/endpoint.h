#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace palp::netem {

/// An IPv4 address and a UDP port.
struct Endpoint {
  std::uint32_t address{};  ///< host byte order
  std::uint16_t port{};     ///< 0: the kernel chooses, when listening
  bool operator==(const Endpoint&) const = default;
};

/// `127.0.0.1:47000` or `localhost:47000`; names are not looked up.
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text);
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

}  // namespace palp::netem
