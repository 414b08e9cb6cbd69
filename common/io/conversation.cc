#include "common/io/conversation.h"

#include <utility>

namespace palp::io {

ConversationOutput PlainConversation::carried(link::SessionOutput output, const Endpoint& to) {
  ConversationOutput out;
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

ConversationOutput PlainConversation::hear(std::span<const std::byte> datagram,
                                           const Endpoint& from,
                                           TimePoint now) {
  return carried(session_.on_datagram(datagram, now), from);
}

ConversationOutput PlainConversation::tick(TimePoint now, const LinkGlance& link) {
  return carried(session_.tick(now, link.state, link.session_id), callee_);
}

ConversationOutput PlainConversation::close(std::string_view why) {
  return carried(session_.close(why), peer_);
}

}  // namespace palp::io
