#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"
#include "common/link/transport.h"

namespace palp::io {

/// The monotonic clock of this machine, for the relay, which has to ask.
[[nodiscard]] TimePoint monotonic_now() noexcept;
/// Since 1970, for captures that others read.
[[nodiscard]] Duration wall_now() noexcept;

/// One datagram as it came out of the kernel.
struct ReceivedDatagram {
  std::span<const std::byte> bytes;  ///< valid until the next receive()
  TimePoint arrived_at{};            ///< the kernel's stamp on the monotonic line
  std::uint8_t tos{};                ///< IP's type of service
};

/// One datagram that is to go.
struct OutgoingDatagram {
  std::span<const std::byte> bytes;
  std::uint8_t tos{};
};

/// Datagrams of one call into the kernel.
inline constexpr std::size_t kDatagramBatch = 64;

/// A UDP socket that never blocks and survives the errors of its peers: they are counted.
/// Thread: its owner's.
class DatagramSocket {
 public:
  /// Bound to `local`. `datagram_max` [bytes]: what is longer is received cut off one byte later.
  /// @throws std::system_error.
  static DatagramSocket bound(const Endpoint& local,
                              std::size_t datagram_max = link::kDatagramSizeMax);
  /// Connected to `peer`: hears nobody else. @throws std::system_error.
  static DatagramSocket connected(const Endpoint& peer,
                                  std::size_t datagram_max = link::kDatagramSizeMax);

  /// The same from `local`, whose port its owner shares for the while (share_port).
  /// @throws std::system_error.
  static DatagramSocket sharing(const Endpoint& local,
                                const Endpoint& peer,
                                std::size_t datagram_max = link::kDatagramSizeMax);

  /// From another port of this machine on, as far as the peer can see; errors are counted on.
  /// @throws std::system_error.
  void reconnect(const Endpoint& peer);

  DatagramSocket(DatagramSocket&& other) noexcept;
  DatagramSocket& operator=(DatagramSocket&& other) noexcept;
  ~DatagramSocket();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] Endpoint local() const;

  /// What waits, at most kDatagramBatch; fewer: nothing more does.
  [[nodiscard]] std::span<const ReceivedDatagram> receive() noexcept;
  /// Who sent the last one of the last receive() that was not empty.
  [[nodiscard]] Endpoint sender_of_last() const noexcept;
  /// Who sent number `index` of it.
  [[nodiscard]] Endpoint sender_of(std::size_t index) const noexcept;
  /// At most kDatagramBatch of them. `to`: for a socket that is bound only. What the kernel does
  /// not take is counted and left out. @returns how many went.
  std::size_t send(std::span<const OutgoingDatagram> datagrams, const Endpoint* to) noexcept;
  /// `to`: for a socket that is bound only. @returns false: not sent, counted.
  bool send(std::span<const std::byte> datagram, const std::optional<Endpoint>& to) noexcept;
  /// Sends nothing, but walks the kernel's way of a send() as far as its last step: after a rest
  /// the next one finds it in the caches.
  void warm(const Endpoint* to) noexcept;
  /// Refused, unreachable, out of buffers ...: what the kernel answered to receive() and send().
  [[nodiscard]] std::uint64_t errors() const noexcept { return errors_; }

 private:
  struct Batch;
  DatagramSocket(int descriptor, std::size_t datagram_max);
  void connect(const Endpoint& peer);

  int descriptor_;
  std::unique_ptr<Batch> batch_;
  bool peer_ipv6_{};
  std::uint64_t errors_{};
};

}  // namespace palp::io
