#pragma once

#include <cstdint>
#include <memory>

#include "common/link/codec.h"

namespace palp::lab {

/// How a patient site lies about a tissue.
struct LieManner {
  enum class Kind : std::uint8_t {
    Tissues,    ///< another random one each time
    TwoInTurn,  ///< a soft and a stiff one
    Stiffness,  ///< one tissue that swells and softens as a sine
    Surface,    ///< one tissue whose surface goes up and down as a sine
    Breath,     ///< one tissue, of which another breath is told each time
    Relaxing,   ///< one tissue that now relaxes and now does not
  };
  Kind kind{Kind::Tissues};
  Duration length{std::chrono::milliseconds{50}};  ///< of a lie; of a sine, half a period
};
/// Any kind, 10 ms to 1 s long.
[[nodiscard]] LieManner drawn_manner(std::uint64_t seed) noexcept;

/// A patient site that lies. Of `mmt` it tells contact models, with versions that rise, in its
/// manner; the others get another lie every 50 ms: of `wave` random waves that declare far too much
/// energy; of `tdpa` forces and an energy that pays for any of them; of `direct` forces. Thread:
/// its link's.
class LyingCodec final : public link::Codec {
 public:
  LyingCodec(std::unique_ptr<link::Codec> codec,
             std::uint64_t seed,
             Duration period,
             const LieManner& manner = {});
  // NOLINTNEXTLINE(bugprone-exception-escape): copying a payload does not throw
  [[nodiscard]] std::size_t encode(
      const WireTelegram& telegram,
      std::span<std::byte, message::kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;

 private:
  [[nodiscard]] ModelPayload tissue(std::uint64_t lie) const noexcept;
  [[nodiscard]] ModelPayload model(double turns) const noexcept;
  [[nodiscard]] WavePayload wave(std::uint64_t lie) noexcept;

  std::unique_ptr<link::Codec> codec_;
  std::uint64_t seed_;
  LieManner manner_;
  double period_;  ///< [s]
  std::uint64_t told_{};
  double wave_integral_{};  ///< [sqrt(W) s]
};

}  // namespace palp::lab
