#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <netinet/in.h>
#include <sys/socket.h>

#include "common/core/host_and_port.h"
#include "common/core/result.h"

namespace palp::io {

/// An address and a UDP port of IPv4 or IPv6. A value.
class Endpoint {
 public:
  /// None: equal to nothing a datagram can come from.
  Endpoint() noexcept = default;
  /// `size` bytes of an address as the kernel gives it; a foreign family gives None.
  Endpoint(const void* address, std::size_t size) noexcept;

  [[nodiscard]] const sockaddr* address() const noexcept;
  [[nodiscard]] socklen_t size() const noexcept { return size_; }
  [[nodiscard]] int family() const noexcept { return address()->sa_family; }
  [[nodiscard]] std::uint16_t port() const noexcept;
  [[nodiscard]] bool valid() const noexcept { return size_ != 0; }
  /// 127.0.0.0/8 or ::1: nothing leaves this machine.
  [[nodiscard]] bool loopback() const noexcept;
  /// `127.0.0.1:9000`, `[::1]:9000`.
  [[nodiscard]] std::string to_string() const;
  /// The same address and port; flow labels do not count.
  [[nodiscard]] bool operator==(const Endpoint& other) const noexcept;
  /// Whether both are of one subscriber: the same IPv4 address, or the same /64 of IPv6, which is
  /// what one customer is given.
  [[nodiscard]] bool same_host(const Endpoint& other) const noexcept;
  /// As the wire tells it: an address of IPv6, IPv4 mapped into it, then the port, all big-endian;
  /// zeros for None.
  using Bytes = std::array<std::byte, 18>;
  [[nodiscard]] Bytes bytes() const noexcept;
  /// Where to call from: the address of the same family that means "any", with port 0; towards a
  /// loopback address a loopback one, which nobody outside this machine can reach.
  [[nodiscard]] Endpoint caller() const noexcept;

 private:
  sockaddr_storage storage_{};
  socklen_t size_{};
};

/// Asks the resolver, so it may take seconds for a host name; IPv4 is preferred.
[[nodiscard]] Result<Endpoint> resolve(const HostAndPort& place);

/// Both in one.
[[nodiscard]] Result<Endpoint> resolve_endpoint(std::string_view text);

}  // namespace palp::io
