#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/link/packet_protection.h"
#include "common/link/replay_window.h"
#include "common/link/traffic_keys.h"
#include "common/link/transport.h"
#include "video/parity.h"

namespace palp::video {

/// Of a session's video: what a handshake left behind for it. A plane of its own, so that no
/// number of force's is ever used twice.
struct MediaKeys {
  std::unique_ptr<link::PacketProtection> protection;
  std::uint32_t send_connection{};
  std::uint32_t receive_connection{};
};

/// Of what a handshake exported; none: a session that seals nothing.
[[nodiscard]] MediaKeys media_keys(const std::optional<link::PlaneKeys>& exported, link::Role role);

/// Payloads to datagrams and back: numbers, seals, refuses what is forged, foreign or was there
/// before. Thread: one.
class MediaSeal {
 public:
  explicit MediaSeal(MediaKeys keys) noexcept : keys_{std::move(keys)} {}

  [[nodiscard]] Bytes seal(std::span<const std::byte> payload);

  struct Opened {
    Bytes payload;
    bool newest{};  ///< its number is above all before
  };
  /// Any bytes. nullopt: refused, and counted.
  [[nodiscard]] std::optional<Opened> open(std::span<const std::byte> datagram);

  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  [[nodiscard]] std::uint64_t sealed() const noexcept { return next_number_; }

 private:
  MediaKeys keys_;
  link::ReplayWindow window_;
  std::uint64_t next_number_{};
  std::uint64_t refused_{};
};

}  // namespace palp::video
