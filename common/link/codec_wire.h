#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/link/codec.h"

namespace palp::link {

/// The wire of the product: message Telegram of proto/link.proto, written and read from its list of
/// fields because a thousand times a second it counts; the bytes are those of protobuf, and what
/// protobuf would read is read alike, in any order of fields. What the schema does not know is
/// refused, and so is a field that comes twice. Numbers that are `float` there are rounded once,
/// when encoded; what was encoded is decoded exactly.
class WireCodec final : public Codec {
 public:
  [[nodiscard]] std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;
};

}  // namespace palp::link
