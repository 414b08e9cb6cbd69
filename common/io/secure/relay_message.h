#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/io/secure/room_key.h"
#include "common/link/telegram.h"

namespace palp::io {

/// What sites and a relay say to each other (WIRE.md, "Relay"). All are of one size: no answer is
/// longer than its question. A value.
struct RelayMessage {
  static constexpr std::size_t kSize = 124;  ///< [bytes]
  static constexpr std::byte kFirstByte{0x84};
  using Bytes = std::array<std::byte, kSize>;
  using Cookie = std::array<std::byte, 24>;

  enum class Kind : std::uint8_t { Ask, Cookie, Join, Joined, Refused };
  Kind kind{};
  link::Role role{};      ///< of the site
  std::uint8_t detail{};  ///< Joined: 1 if the other site is in the room
  RoomId room{};
  Cookie cookie{};    ///< zeros in an Ask
  RoomProof proof{};  ///< Join: signature; Ask: random bytes, which the Cookie repeats

  /// nullopt: another size or first byte, or a value that means nothing.
  [[nodiscard]] static std::optional<RelayMessage> parse(std::span<const std::byte> datagram);
  [[nodiscard]] Bytes bytes() const noexcept;
  /// What the proof of a Join is about: all that stands before it.
  [[nodiscard]] std::array<std::byte, kSize - sizeof(RoomProof)> claim() const noexcept;
};

}  // namespace palp::io
