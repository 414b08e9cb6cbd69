#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/message/limits.h"
#include "common/message/telegram.h"

/// Telegrams as bytes. Form is checked here (sizes, finite, in range); meaning by those who use it.
namespace palp::link {

/// True where every number keeps its limits and fields agree with each other: what encode() and
/// decode() carry.
[[nodiscard]] bool well_formed(const WireTelegram& telegram) noexcept;

/// Thread: one per object, its Link's; any thread at a time. Allocates nothing after construction.
class Codec {
 public:
  virtual ~Codec() = default;
  /// @returns bytes written, 0 where the telegram is not well formed.
  [[nodiscard]] virtual std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept = 0;
  /// Any bytes may be given. What comes out is well formed.
  [[nodiscard]] virtual std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept = 0;
};

/// A copy of the struct in this machine's layout: for virtual time only, never for a network.
class RawCodec final : public Codec {
 public:
  [[nodiscard]] std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;
};

}  // namespace palp::link
