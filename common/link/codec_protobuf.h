#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/link/codec.h"

namespace palp::link {

/// The wire of the product: message Telegram of proto/link.proto. Numbers that are `float` there
/// are rounded once, when encoded; what was encoded is decoded exactly.
class ProtobufCodec final : public Codec {
 public:
  ProtobufCodec();
  [[nodiscard]] std::size_t encode(const WireTelegram& telegram,
                                   std::span<std::byte> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;

 private:
  static constexpr std::size_t kBlockSize = 8192;  ///< [bytes]; a telegram with all takes < 1,500
  static constexpr std::size_t kFieldNumbers = 16;
  static constexpr std::size_t kDepthMax = 4;  ///< nested messages; the schema has 3

  /// What the schema allows at one field number.
  struct Field {
    std::uint8_t wire_type{kForbidden};
    std::uint8_t message{};       ///< index into shapes_, for a nested one
    std::uint16_t excluded_by{};  ///< bit n: not together with field n; itself: not twice
  };
  static constexpr std::uint8_t kForbidden = 0xFF;
  using Shape = std::array<Field, kFieldNumbers>;
  struct ShapeBuilder;

  /// Refuses unknown and repeated fields before the parser, which would allocate for them.
  [[nodiscard]] bool fits(std::size_t shape,
                          std::span<const std::byte> bytes,
                          std::size_t depth) const noexcept;

  std::vector<Shape> shapes_;  ///< one per message, from the schema itself; [0]: Telegram
  alignas(std::max_align_t) std::array<char, kBlockSize> block_{};
};

}  // namespace palp::link
