#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace palp::config {

/// A numeric address and a port. Names are not resolved here, and nothing is opened.
struct Endpoint {
  std::string address;   ///< "127.0.0.1" or "::1", without brackets
  std::uint16_t port{};  ///< 0: any free one, where one listens

  friend bool operator==(const Endpoint&, const Endpoint&) = default;
};

/// "127.0.0.1:9000", "localhost:9000" (127.0.0.1), "[::1]:9000". A port below `port_min` is
/// refused: 1 where one sends to.
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text, std::uint16_t port_min = 0);

/// The text that reads back as `endpoint`.
[[nodiscard]] std::string to_string(const Endpoint& endpoint);

}  // namespace palp::config
