#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace palp {

/// Where to listen or whom to call, as people write it. Nothing is resolved and nothing opened.
struct HostAndPort {
  std::string host;      ///< name or numeric address, IPv6 without brackets
  std::uint16_t port{};  ///< 0: any free one, where one listens

  /// As it is written: reads back as itself.
  [[nodiscard]] std::string to_string() const;
  friend bool operator==(const HostAndPort&, const HostAndPort&) = default;
};

/// "patient.example.org:9000", "127.0.0.1:9000", "[::1]:9000". A port below `port_min` is refused:
/// 1 where one calls.
[[nodiscard]] Result<HostAndPort> parse_host_and_port(std::string_view text,
                                                      std::uint16_t port_min = 0);

}  // namespace palp
