#pragma once

#include <cstdint>
#include <memory>

#include "common/link/codec.h"

namespace palp::lab {

/// A patient site that lies, another lie every 50 ms. Of `mmt` it tells random contact models, with
/// versions that rise; of `wave` random waves that declare far too much energy; of `tdpa` forces
/// and an energy that pays for any of them; of `direct` forces. Thread: its link's.
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
  [[nodiscard]] ModelPayload model(std::uint64_t lie) const noexcept;
  [[nodiscard]] WavePayload wave(std::uint64_t lie) noexcept;

  std::unique_ptr<link::Codec> codec_;
  std::uint64_t seed_;
  std::uint64_t telegrams_per_lie_;
  double period_;  ///< [s]
  std::uint64_t told_{};
  double wave_integral_{};  ///< [sqrt(W) s]
};

}  // namespace palp::lab
