#include "netem/model/impaired_transport.h"

#include <utility>

#include "common/core/check.h"

namespace palp::netem {

ImpairedTransport::ImpairedTransport(std::unique_ptr<link::Transport> inner, Channel channel)
    : inner_{std::move(inner)}, channel_{std::move(channel)}, drained_at_{TimePoint::min()} {
  PALP_CHECK(inner_ != nullptr, "there is a transport to impair");
}

bool ImpairedTransport::send(std::span<const std::byte> datagram, TimePoint now) noexcept {
  return inner_->send(datagram, now);
}

std::optional<link::Datagram> ImpairedTransport::receive(
    std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept {
  drain(buffer, now);
  const auto released = channel_.pop(buffer, now);
  if (!released) return std::nullopt;
  return link::Datagram{released->size, released->released_at};
}

/// Moves what waits in the inner transport into the channel, at most kDatagramsPerTickMax a tick.
void ImpairedTransport::drain(std::span<std::byte, link::kDatagramSizeMax> buffer,
                              TimePoint now) noexcept {
  if (now != drained_at_) {
    drained_at_ = now;
    drained_ = 0;
  }
  for (; drained_ < link::kDatagramsPerTickMax; ++drained_) {
    const auto datagram = inner_->receive(buffer, now);
    if (!datagram) return;
    if (datagram->size > buffer.size()) {
      ++cut_off_;
      continue;
    }
    channel_.push(buffer.first(datagram->size), datagram->arrived_at);
  }
}

}  // namespace palp::netem
