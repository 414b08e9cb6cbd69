#include "common/io/secure/session_endpoint.h"

#include <utility>

namespace palp::io {

SessionEndpointOutput PlainSession::carried(link::SessionOutput output, const Endpoint& to) {
  SessionEndpointOutput out;
  for (const link::ControlBytes& datagram : output.datagrams) {
    const auto bytes = datagram.view();
    out.letters.push_back({to, {bytes.begin(), bytes.end()}});
  }
  out.event = std::move(output.event);
  if (out.event && std::holds_alternative<link::Established>(*out.event)) {
    out.protection = std::make_unique<link::PlainProtection>();
    peer_ = to;
  }
  return out;
}

SessionEndpointOutput PlainSession::hear(std::span<const std::byte> datagram,
                                         const Endpoint& from,
                                         TimePoint now) {
  return carried(session_.on_datagram(datagram, now), from);
}

SessionEndpointOutput PlainSession::tick(TimePoint now, const LinkGlance& link) {
  return carried(session_.tick(now, link.state, link.session_id), callee_);
}

SessionEndpointOutput PlainSession::close(std::string_view why) {
  return carried(session_.close(why), peer_);
}

}  // namespace palp::io
