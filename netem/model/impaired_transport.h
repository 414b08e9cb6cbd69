#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/link/transport.h"
#include "netem/model/channel.h"

namespace palp::netem {

/// A transport whose receiving side is impaired: what the inner one receives passes through the
/// channel first. Times are the inner arrival stamps; a release is seen at the next receive() at
/// or after it, so on the tick grid of the site. Sending is left alone.
/// Thread: rt (its Link's). Owns the inner transport.
class ImpairedTransport final : public link::Transport {
 public:
  ImpairedTransport(std::unique_ptr<link::Transport> inner, Channel channel);

  bool send(std::span<const std::byte> datagram, TimePoint now) noexcept override;
  std::optional<link::Datagram> receive(std::span<std::byte, link::kDatagramSizeMax> buffer,
                                        TimePoint now) noexcept override;
  void recognised(TimePoint now) noexcept override { inner_->recognised(now); }
  void warm_up() noexcept override { inner_->warm_up(); }

  [[nodiscard]] const Channel& channel() const noexcept { return channel_; }
  /// Datagrams longer than kDatagramSizeMax: dropped before the channel.
  [[nodiscard]] std::uint64_t cut_off() const noexcept { return cut_off_; }

 private:
  void drain(std::span<std::byte, link::kDatagramSizeMax> buffer, TimePoint now) noexcept;

  std::unique_ptr<link::Transport> inner_;
  Channel channel_;
  TimePoint drained_at_;   ///< the tick that drained_ belongs to
  std::size_t drained_{};  ///< datagrams taken from the inner transport in this tick
  std::uint64_t cut_off_{};
};

}  // namespace palp::netem
