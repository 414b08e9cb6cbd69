#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/core/mailbox.h"
#include "common/core/spsc_queue.h"
#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/link/transport.h"

namespace palp::io {

/// A datagram that is not for the control thread: a Hello, a Bye, or anybody's noise.
struct SideDatagram {
  SideDatagram() = default;
  /// What is longer than kDatagramSizeMax is cut off there: it breaks a rule of form either way.
  SideDatagram(std::span<const std::byte> datagram,
               const Endpoint& sender,
               TimePoint arrival) noexcept
      : from{sender}, size{std::min(datagram.size(), link::kDatagramSizeMax)}, arrived_at{arrival} {
    std::copy_n(datagram.begin(), size, bytes.begin());
  }
  [[nodiscard]] std::span<const std::byte> datagram() const noexcept {
    return {bytes.data(), size};
  }

  Endpoint from;
  std::size_t size{};  ///< [bytes], at most kDatagramSizeMax
  TimePoint arrived_at{};
  std::array<std::byte, link::kDatagramSizeMax> bytes{};
};

/// What the connected sockets of a site have seen; never falls, also when a socket is replaced.
struct SocketCounts {
  std::uint64_t sent{};
  std::uint64_t unsent{};         ///< refused by the kernel
  std::uint64_t received{};       ///< all that was taken from the kernel
  std::uint64_t set_aside{};      ///< not data: left to io
  std::uint64_t dropped{};        ///< not data, and the inbox was full or it was empty or too long
  std::uint64_t detoured{};       ///< copies sent to an address that is being proven
  std::uint64_t path_errors{};    ///< ICMP and the like, as the kernel reports them
  std::uint64_t without_stamp{};  ///< no receive stamp, or a senseless one: the drain's time counts
};

/// Where rt leaves to io what it received but must not look into, and io to rt the telegrams that
/// came from an address that is being proven. Outlives the sockets that fill it.
struct SideInbox {
  static constexpr std::size_t kCapacity = 64;

  SpscQueue<SideDatagram> datagrams{kCapacity};  ///< writer: rt, reader: io
  SpscQueue<SideDatagram> detours{kCapacity};    ///< writer: io, reader: rt
  SocketCounts counting;                         ///< rt's own
  TimePoint peer_heard_at{};                     ///< rt's own: a telegram over the peer's address
  Mailbox<SocketCounts> counts;                  ///< its copy for io
};

}  // namespace palp::io
