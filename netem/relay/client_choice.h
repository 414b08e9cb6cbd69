#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/core/time.h"
#include "common/io/net/endpoint.h"

namespace palp::netem {

/// Which address is the client that replies go to. The first one is. Another takes its place with
/// a reason only: the client was silent for a window and the other one sent what looks like ours;
/// it was silent for kSilent; or in a window the other one sent more than the client. So a site
/// that moved or restarted is followed at once or within a window, and datagrams of strangers
/// divert nothing for longer than a window. Thread: the relay's. Allocates nothing.
class ClientChoice {
 public:
  static constexpr Duration kWindow = std::chrono::milliseconds{100};
  static constexpr Duration kSilent = std::chrono::seconds{1};

  /// A datagram from `sender` came at `now`, which does not fall.
  void heard(const io::Endpoint& sender,
             std::span<const std::byte> datagram,
             TimePoint now) noexcept;
  [[nodiscard]] const std::optional<io::Endpoint>& client() const noexcept { return client_; }

 private:
  void follow(const io::Endpoint& sender, TimePoint now) noexcept;
  void begin_window(TimePoint now) noexcept;

  std::optional<io::Endpoint> client_;
  TimePoint client_heard_at_{};
  std::uint32_t client_count_{};  ///< in this window
  io::Endpoint other_;            ///< who sends most of those that are not the client
  std::uint32_t other_count_{};
  TimePoint window_began_at_{};
};

}  // namespace palp::netem
