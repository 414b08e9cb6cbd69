#include "common/io/net/source_watch.h"

#include <algorithm>
#include <span>

#include <sys/socket.h>

#include "common/io/process/descriptor.h"

namespace palp::io {
namespace {

bool same_address(const Endpoint& one, const Endpoint& other) {
  constexpr std::size_t kAddress = 16;  // [bytes]; the port follows
  const Endpoint::Bytes a = one.bytes();
  const Endpoint::Bytes b = other.bytes();
  return std::ranges::equal(std::span{a}.first<kAddress>(), std::span{b}.first<kAddress>());
}

}  // namespace

Endpoint source_towards(const Endpoint& peer) {
  const Descriptor socket{::socket(peer.family(), SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  const Endpoint from = peer.caller();
  if (!socket.valid() || ::bind(socket.number(), from.address(), from.size()) != 0 ||
      ::connect(socket.number(), peer.address(), peer.size()) != 0) {
    return {};
  }
  sockaddr_storage name{};
  socklen_t length = sizeof name;
  if (::getsockname(socket.number(), reinterpret_cast<sockaddr*>(&name), &length) != 0) return {};
  return {&name, length};
}

bool SourceWatch::has_changed(TimePoint now) {
  if (!peer_.valid() || (looked_at_ && now - *looked_at_ < kPause)) return false;
  looked_at_ = now;
  const Endpoint source = source_towards(peer_);
  return source.valid() && !same_address(source, own_);  // without a way nothing would be better
}

}  // namespace palp::io
