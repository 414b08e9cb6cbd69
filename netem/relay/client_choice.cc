#include "netem/relay/client_choice.h"

namespace palp::netem {
namespace {

constexpr std::size_t kShortest = 13;  ///< [bytes] of any datagram of ours: a record's header

/// A telegram, a control message, video or a record of a handshake, by its first byte (WIRE.md).
bool looks_like_ours(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() < kShortest) return false;
  const auto first = std::to_integer<unsigned>(datagram[0]);
  return (first >= 0x80 && first <= 0x85) || (first >= 20 && first <= 63);
}

}  // namespace

void ClientChoice::heard(const io::Endpoint& sender,
                         std::span<const std::byte> datagram,
                         TimePoint now) noexcept {
  if (!client_) follow(sender, now);
  if (now - window_began_at_ >= kWindow) {
    if (other_count_ > client_count_) follow(other_, now);
    begin_window(now);
  }
  if (sender == *client_) {
    client_heard_at_ = now;
    ++client_count_;
    return;
  }
  const Duration silence = now - client_heard_at_;
  if (silence >= kSilent || (silence >= kWindow && looks_like_ours(datagram))) {
    return follow(sender, now);
  }
  if (other_count_ == 0 || sender == other_) {
    other_ = sender;
    ++other_count_;
  } else {
    --other_count_;  // who is left has sent more than all the others beside it
  }
}

void ClientChoice::follow(const io::Endpoint& sender, TimePoint now) noexcept {
  client_ = sender;
  client_heard_at_ = now;
  begin_window(now);
}

void ClientChoice::begin_window(TimePoint now) noexcept {
  client_count_ = 0;
  other_count_ = 0;
  window_began_at_ = now;
}

}  // namespace palp::netem
