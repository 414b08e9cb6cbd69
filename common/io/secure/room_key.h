#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "common/core/result.h"

/// What two sites that meet at a relay know of each other and the relay need not know: the name of
/// their room gives both the same key of Ed25519 (RFC 8032), whose public half is all that others
/// see.
namespace palp::io {

using RoomId = std::array<std::byte, 32>;     ///< the public half
using RoomProof = std::array<std::byte, 64>;  ///< a signature

class RoomKey {
 public:
  /// Whoever guesses a name can take a seat in the room, so it must be long.
  static constexpr std::size_t kNameMin = 16;  ///< [characters]
  static constexpr std::size_t kNameMax = 64;  ///< [characters]

  /// A sentence where the name is too short, too long, or has other than printable characters.
  [[nodiscard]] static Result<RoomKey> from_name(std::string_view name);
  RoomKey(RoomKey&&) noexcept;
  RoomKey& operator=(RoomKey&&) noexcept;
  ~RoomKey();

  [[nodiscard]] const RoomId& id() const noexcept { return id_; }
  [[nodiscard]] RoomProof sign(std::span<const std::byte> message) const;

 private:
  struct Key;
  RoomKey();

  std::unique_ptr<Key> key_;
  RoomId id_{};
};

/// Whether who made the proof knew the name of the room. Costs 0.1 ms.
[[nodiscard]] bool proves_room(const RoomId& room,
                               std::span<const std::byte> message,
                               const RoomProof& proof) noexcept;

}  // namespace palp::io
