#include "common/config/endpoint.h"

#include <limits>

#include <arpa/inet.h>

#include "common/config/number.h"

namespace palp::config {
namespace {

bool is_address(int family, const std::string& text) {
  in6_addr address{};  // room for either family
  // inet_pton reads up to a NUL: what follows one must not slip through.
  return text.find('\0') == std::string::npos && inet_pton(family, text.c_str(), &address) == 1;
}

}  // namespace

Result<Endpoint> parse_endpoint(std::string_view text, std::uint16_t port_min) {
  const auto colon = text.rfind(':');
  if (colon == std::string_view::npos) {
    return fail('"' + printable(text) + "\" is not HOST:PORT, as in 127.0.0.1:9000");
  }
  std::string host{text.substr(0, colon)};
  const bool bracketed = host.size() >= 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) {
    host = host.substr(1, host.size() - 2);
  } else if (host == "localhost") {
    host = "127.0.0.1";
  }
  if (!is_address(bracketed ? AF_INET6 : AF_INET, host)) {
    return fail('"' + printable(host) + "\" in \"" + printable(text) +
                "\" is not a numeric address: 127.0.0.1, [::1] or localhost");
  }
  const std::string_view digits = text.substr(colon + 1);
  const auto port = parse_whole(digits);
  if (!port || *port < port_min || *port > std::numeric_limits<std::uint16_t>::max()) {
    return fail("port \"" + printable(digits) + "\" in \"" + printable(text) +
                "\" is out of range: " + std::to_string(port_min) + " to 65535");
  }
  return Endpoint{.address = std::move(host), .port = static_cast<std::uint16_t>(*port)};
}

std::string to_string(const Endpoint& endpoint) {
  const bool six = endpoint.address.find(':') != std::string::npos;
  const std::string host = six ? '[' + endpoint.address + ']' : endpoint.address;
  return host + ':' + std::to_string(endpoint.port);
}

}  // namespace palp::config
