#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/link/codec.h"

namespace palp::link {

/// What WireCodec is held against: message Telegram of proto/link.proto by protobuf's own code and
/// the schema's own description, which know nothing of how the product writes and reads it.
class ProtobufCodec final : public Codec {
 public:
  ProtobufCodec();
  [[nodiscard]] std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;

 private:
  static constexpr std::size_t kFieldNumbers = 32;
  static constexpr std::size_t kDepthMax = 4;  ///< nested messages; the schema has 3

  /// What the schema allows at one field number.
  struct Field {
    std::uint8_t wire_type{kForbidden};
    std::uint8_t message{};       ///< index into shapes_, for a nested one
    std::uint32_t excluded_by{};  ///< bit n: not together with field n; itself: not twice
  };
  static constexpr std::uint8_t kForbidden = 0xFF;
  using Shape = std::array<Field, kFieldNumbers>;
  struct ShapeBuilder;

  /// Refuses unknown and repeated fields, which the parser would take.
  [[nodiscard]] bool fits(std::size_t shape,
                          std::span<const std::byte> bytes,
                          std::size_t depth) const noexcept;

  std::vector<Shape> shapes_;  ///< one per message, from the schema itself; [0]: Telegram
};

}  // namespace palp::link
