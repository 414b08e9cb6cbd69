#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/core/histogram.h"
#include "common/core/time.h"
#include "common/io/endpoint.h"
#include "common/link/transport.h"
#include "netem/channel.h"
#include "netem/datagram_socket.h"
#include "netem/impairment.h"

namespace palp::netem {

struct RelayConfig {
  io::Endpoint listen;   ///< the surgeon's side
  io::Endpoint forward;  ///< the patient's
  Impairment up{};       ///< surgeon to patient
  Impairment down{};     ///< patient to surgeon
  std::uint64_t seed{1};
  std::size_t in_flight_max{16384};  ///< datagrams each way: 2 s of delay at 8 kHz
  int priority{};                    ///< SCHED_FIFO 1..99 if permitted; 0: leave it as it is
  int stop_descriptor{-1};           ///< serve() ends when this becomes readable
};

/// Counted at the relay's sockets, beside the channel's own counters.
struct RelayTraffic {
  std::uint64_t forwarded{};      ///< sent on
  std::uint64_t unsent{};         ///< released, but nobody to send to, or refused by the kernel
  std::uint64_t late_releases{};  ///< sent more than 60 us after their time
  std::uint64_t socket_errors{};  ///< of the socket that this direction leaves by
  Histogram delay;                ///< from the kernel's arrival stamp to the end of the send call
  Histogram release_error;        ///< distance of the end of the send call from the time decided
};

/// The impaired path as a process: two UDP ports with a Channel for each direction between them.
/// Whoever sent last to the listening port is the client that replies go to, so a restarted
/// surgeon with a new port simply becomes it. A peer that vanishes is counted, nothing more.
/// Thread: the one that constructs and serves it; it asks the clock and waits in the kernel, but
/// spins the last 60 us before a release.
class Relay {
 public:
  /// @throws std::system_error when a socket cannot be opened.
  explicit Relay(const RelayConfig& config);

  /// Works for `span`, or until the stop descriptor is readable. @returns false: told to stop.
  bool serve(Duration span);

  [[nodiscard]] io::Endpoint listening_on() const { return client_side_.local(); }
  /// Where the patient sees us.
  [[nodiscard]] io::Endpoint forwarding_from() const { return server_side_.local(); }
  [[nodiscard]] const std::optional<io::Endpoint>& client() const noexcept { return client_; }
  [[nodiscard]] bool real_time() const noexcept { return real_time_; }
  [[nodiscard]] const Channel& channel(Direction direction) const noexcept {
    return direction == Direction::Up ? up_ : down_;
  }
  [[nodiscard]] RelayTraffic traffic(Direction direction) const;

 private:
  void drain() noexcept;
  void release(TimePoint now) noexcept;
  void release(Direction direction, Channel& channel, TimePoint now) noexcept;
  void rest(TimePoint now, TimePoint until) noexcept;
  [[nodiscard]] bool told_to_stop() const noexcept;

  DatagramSocket client_side_;
  DatagramSocket server_side_;
  Channel up_;
  Channel down_;
  int stop_descriptor_;
  bool real_time_;
  std::optional<io::Endpoint> client_;
  std::array<RelayTraffic, 2> traffic_;  ///< by Direction
  Duration lead_{};                      ///< running median of what a send call takes
  TimePoint awake_since_{};
  std::array<std::byte, link::kDatagramSizeMax> buffer_{};
};

}  // namespace palp::netem
