#include "common/core/host_and_port.h"

#include <algorithm>
#include <charconv>

#include "common/core/printable.h"

namespace palp {
namespace {

/// What names and numeric addresses are made of, zones of IPv6 included. It keeps blanks and a NUL,
/// up to which C reads, away from the resolver.
bool may_be_in_host(char c) noexcept {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         std::string_view{".-_:%"}.find(c) != std::string_view::npos;
}

}  // namespace

std::string HostAndPort::to_string() const {
  const bool brackets = host.find(':') != std::string::npos;
  return (brackets ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<HostAndPort> parse_host_and_port(std::string_view text, std::uint16_t port_min) {
  const std::string quoted = "address \"" + printable(text) + "\"";
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) {
    return fail(quoted + " has no port; expected HOST:PORT, for example 127.0.0.1:9000");
  }
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    if (host.find(':') == std::string_view::npos) {
      return fail(quoted + " has brackets around what is no IPv6 address");
    }
  } else if (host.find(':') != std::string_view::npos) {
    return fail(quoted + " needs brackets around an IPv6 address, for example [::1]:9000");
  }
  if (host.empty()) {
    return fail(quoted + " has no host; expected HOST:PORT, for example 127.0.0.1:9000");
  }
  if (!std::all_of(host.begin(), host.end(), may_be_in_host)) {
    return fail(quoted + " has the host \"" + printable(host) +
                "\"; expected a name or a numeric address");
  }
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (error != std::errc{} || end != port.data() + port.size() || number < port_min) {
    return fail(quoted + " has the port \"" + printable(port) + "\"; expected " +
                std::to_string(port_min) + " to 65535");
  }
  return HostAndPort{.host = std::string{host}, .port = number};
}

}  // namespace palp
