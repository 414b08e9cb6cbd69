#include "common/io/net/endpoint.h"

#include <array>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <netdb.h>

namespace palp::io {
namespace {

struct FreeAddresses {
  void operator()(addrinfo* list) const noexcept { freeaddrinfo(list); }
};

const sockaddr_in6& in6(const sockaddr* address) noexcept {
  return *reinterpret_cast<const sockaddr_in6*>(address);
}

/// Whether both are addresses of one family and the same, of IPv6 in their first bytes.
bool agree(const sockaddr* a, const sockaddr* b, std::size_t ipv6_bytes) noexcept {
  if (a->sa_family != b->sa_family) {
    return false;
  }
  if (a->sa_family == AF_INET) {
    return reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr ==
           reinterpret_cast<const sockaddr_in*>(b)->sin_addr.s_addr;
  }
  return std::memcmp(&in6(a).sin6_addr, &in6(b).sin6_addr, ipv6_bytes) == 0;
}

}  // namespace

Endpoint::Endpoint(const void* address, std::size_t size) noexcept {
  sa_family_t family = AF_UNSPEC;
  if (size < sizeof family || size > sizeof storage_) {
    return;
  }
  std::memcpy(&family, address, sizeof family);
  const std::size_t needed = family == AF_INET    ? sizeof(sockaddr_in)
                             : family == AF_INET6 ? sizeof(sockaddr_in6)
                                                  : 0;
  if (needed == 0 || size < needed) {
    return;
  }
  std::memcpy(&storage_, address, needed);
  size_ = static_cast<socklen_t>(needed);
}

const sockaddr* Endpoint::address() const noexcept {
  return reinterpret_cast<const sockaddr*>(&storage_);
}

std::uint16_t Endpoint::port() const noexcept {
  if (family() == AF_INET) {
    return ntohs(reinterpret_cast<const sockaddr_in*>(&storage_)->sin_port);
  }
  if (family() == AF_INET6) {
    return ntohs(reinterpret_cast<const sockaddr_in6*>(&storage_)->sin6_port);
  }
  return 0;
}

bool Endpoint::loopback() const noexcept {
  if (family() == AF_INET) {
    const auto& ipv4 = reinterpret_cast<const sockaddr_in&>(storage_);
    return ntohl(ipv4.sin_addr.s_addr) >> IN_CLASSA_NSHIFT == IN_LOOPBACKNET;
  }
  if (family() == AF_INET6) {
    const auto& ipv6 = reinterpret_cast<const sockaddr_in6&>(storage_);
    return std::memcmp(&ipv6.sin6_addr, &in6addr_loopback, sizeof in6addr_loopback) == 0;
  }
  return false;
}

std::string Endpoint::to_string() const {
  if (!valid()) {
    return "no address";
  }
  std::array<char, NI_MAXHOST> host{};
  if (getnameinfo(address(), size_, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return "unprintable address";
  }
  const std::string name = host.data();
  const std::string bracketed = family() == AF_INET6 ? "[" + name + "]" : name;
  return bracketed + ":" + std::to_string(port());
}

Endpoint::Bytes Endpoint::bytes() const noexcept {
  Bytes bytes{};
  if (!valid()) return bytes;
  if (family() == AF_INET6) {
    std::memcpy(bytes.data(), &in6(address()).sin6_addr, sizeof(in6_addr));
  } else {
    constexpr std::size_t kMapped = 12;
    bytes[kMapped - 2] = bytes[kMapped - 1] = std::byte{0xFF};
    std::memcpy(&bytes[kMapped],
                &reinterpret_cast<const sockaddr_in*>(address())->sin_addr,
                sizeof(in_addr));
  }
  bytes[bytes.size() - 2] = static_cast<std::byte>(port() >> 8U);
  bytes[bytes.size() - 1] = static_cast<std::byte>(port() & 0xFFU);
  return bytes;
}

bool Endpoint::operator==(const Endpoint& other) const noexcept {
  if (!valid() || !other.valid() || port() != other.port() ||
      !agree(address(), other.address(), sizeof(in6_addr))) {
    return false;
  }
  return family() != AF_INET6 || in6(address()).sin6_scope_id == in6(other.address()).sin6_scope_id;
}

bool Endpoint::same_host(const Endpoint& other) const noexcept {
  if (!valid() || !other.valid()) {
    return false;
  }
  constexpr std::size_t kPrefix = 8;  // [bytes]
  // All mapped ones share a prefix.
  const bool ipv4 = family() == AF_INET6 && IN6_IS_ADDR_V4MAPPED(&in6(address()).sin6_addr);
  return agree(address(), other.address(), ipv4 ? sizeof(in6_addr) : kPrefix);
}

Endpoint Endpoint::caller() const noexcept {
  if (family() == AF_INET6) {
    sockaddr_in6 from{};
    from.sin6_family = AF_INET6;
    from.sin6_addr = loopback() ? in6addr_loopback : in6addr_any;
    return {&from, sizeof from};
  }
  sockaddr_in from{};
  from.sin_family = AF_INET;
  from.sin_addr.s_addr = htonl(loopback() ? INADDR_LOOPBACK : INADDR_ANY);
  return {&from, sizeof from};
}

Result<Endpoint> resolve(const HostAndPort& place) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  const std::string port = std::to_string(place.port);
  addrinfo* list = nullptr;
  const int refusal = getaddrinfo(place.host.c_str(), port.c_str(), &hints, &list);
  const std::unique_ptr<addrinfo, FreeAddresses> owner{list};
  if (refusal != 0) {
    return fail("cannot find host \"" + place.host + "\": " + gai_strerror(refusal));
  }
  const addrinfo* chosen = list;
  for (const addrinfo* one = list; one != nullptr; one = one->ai_next) {
    if (one->ai_family == AF_INET) {
      chosen = one;
      break;
    }
  }
  const Endpoint endpoint{chosen->ai_addr, chosen->ai_addrlen};
  if (!endpoint.valid()) {
    return fail("host \"" + place.host + "\" has no IPv4 or IPv6 address");
  }
  return endpoint;
}

Result<Endpoint> resolve_endpoint(std::string_view text) {
  return parse_host_and_port(text).and_then(resolve);
}

}  // namespace palp::io
