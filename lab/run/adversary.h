#pragma once

#include <cstdint>
#include <memory>

#include "common/link/codec.h"

namespace palp::lab {

/// A patient site that lies: puts a random contact model into every telegram it encodes, another
/// one every 50 ms, with versions that rise. Thread: its link's.
class LyingCodec final : public link::Codec {
 public:
  LyingCodec(std::unique_ptr<link::Codec> codec, std::uint64_t seed, Duration period);
  // NOLINTNEXTLINE(bugprone-exception-escape): copying a payload does not throw
  [[nodiscard]] std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;

 private:
  std::unique_ptr<link::Codec> codec_;
  std::uint64_t seed_;
  std::uint64_t telegrams_per_lie_;
  std::uint64_t told_{};
};

}  // namespace palp::lab
