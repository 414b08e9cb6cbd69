#include "netem/endpoint.h"

#include <charconv>

#include <arpa/inet.h>

namespace palp::netem {

Result<Endpoint> parse_endpoint(std::string_view text) {
  const std::string quoted = "address '" + std::string{text} + "'";
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) {
    return fail(quoted + " has no port, expected ADDRESS:PORT as 127.0.0.1:47000");
  }
  std::string host{text.substr(0, colon)};
  if (host == "localhost") host = "127.0.0.1";
  in_addr address{};
  if (::inet_pton(AF_INET, host.c_str(), &address) != 1) {
    return fail(quoted + " is not numeric, expected an IPv4 address as 127.0.0.1, or localhost");
  }
  const std::string_view digits = text.substr(colon + 1);
  Endpoint endpoint{ntohl(address.s_addr), 0};
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), endpoint.port);
  if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size()) {
    return fail(quoted + " has no port from 0 to 65535");
  }
  return endpoint;
}

std::string to_string(const Endpoint& endpoint) {
  const auto byte = [&endpoint](unsigned shift) {
    return std::to_string((endpoint.address >> shift) & 0xffU);
  };
  return byte(24) + "." + byte(16) + "." + byte(8) + "." + byte(0) + ":" +
         std::to_string(endpoint.port);
}

}  // namespace palp::netem
