#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/core/time.h"
#include "common/io/endpoint.h"

namespace palp::netem {

/// The monotonic clock of this machine, for the relay, which has to ask.
[[nodiscard]] TimePoint monotonic_now() noexcept;

/// One datagram as it came out of the kernel.
struct ReceivedDatagram {
  std::span<const std::byte> bytes;  ///< valid until the next receive()
  TimePoint arrived_at{};            ///< the kernel's stamp on the monotonic line
  io::Endpoint from;
};

/// A UDP socket that never blocks and survives the errors of its peers: they are counted.
/// Thread: its owner's.
class DatagramSocket {
 public:
  /// Bound to `local`. @throws std::system_error.
  static DatagramSocket bound(const io::Endpoint& local);
  /// Connected to `peer`: hears nobody else. @throws std::system_error.
  static DatagramSocket connected(const io::Endpoint& peer);

  DatagramSocket(DatagramSocket&& other) noexcept;
  DatagramSocket& operator=(DatagramSocket&&) = delete;
  ~DatagramSocket();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] io::Endpoint local() const;

  /// What waits, at most 64 datagrams; empty: nothing does.
  [[nodiscard]] std::span<const ReceivedDatagram> receive() noexcept;
  /// `to`: for a socket that is bound only. @returns false: not sent, counted.
  bool send(std::span<const std::byte> datagram, const std::optional<io::Endpoint>& to) noexcept;
  /// Refused, unreachable, out of buffers ...: what the kernel answered to receive() and send().
  [[nodiscard]] std::uint64_t errors() const noexcept { return errors_; }

 private:
  struct Batch;
  explicit DatagramSocket(int descriptor);

  int descriptor_;
  std::unique_ptr<Batch> batch_;
  std::uint64_t errors_{};
};

}  // namespace palp::netem
