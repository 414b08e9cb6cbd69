#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "common/link/header.h"
#include "common/link/telegram.h"

/// Telegrams as bytes. Form is checked here (sizes, finite, in range); meaning by those who use it.
namespace palp::link {

inline constexpr std::uint64_t kNothingHeard = std::numeric_limits<std::uint64_t>::max();

/// Limits of form, far outside of anything physical: proto/WIRE.md.
inline constexpr std::uint64_t kSentAtMaxNs = 1ULL << 53U;  ///< [ns], 104 days
inline constexpr std::uint32_t kHoldMaxUs = 60'000'000;     ///< [us], a session ends before
inline constexpr double kLengthMax = 10;                    ///< [m]
inline constexpr double kSpeedMax = 1e3;                    ///< [m/s]
inline constexpr double kForceMax = 1e5;                    ///< [N]
inline constexpr double kSumMax = 1e9;                      ///< [J] and [sqrt(W) s]

/// Larger than any telegram of any codec, smaller than a datagram.
inline constexpr std::size_t kTelegramSizeMax = 1024;  ///< [bytes]

/// What crosses: the node's Telegram and what the link adds. Plain numbers with the unit in the
/// name, because this is a border.
struct WireTelegram {
  std::uint64_t sent_at_ns{};            ///< since the sender's session start
  std::uint64_t echo_ns{kNothingHeard};  ///< newest sent_at_ns received
  std::uint64_t newest_number{};         ///< this and the next two: 0 while nothing was heard
  std::uint32_t before_newest{};         ///< bit k: number newest_number - 1 - k was received
  std::uint32_t hold_us{};               ///< arrival of the echoed telegram to this departure
  Telegram telegram;
  std::array<PortSample, 2> older{};  ///< of 5 and 10 ms before; payload: wave or none
  std::uint8_t older_count{};         ///< 0 to 2
};

/// True where every number keeps its limits: what encode() and decode() agree to carry.
[[nodiscard]] bool well_formed(const WireTelegram& telegram) noexcept;

/// Thread: one per object, its Link's; any thread at a time. Allocates nothing after construction.
class Codec {
 public:
  virtual ~Codec() = default;
  /// @returns bytes written, 0 where the telegram is not well formed.
  [[nodiscard]] virtual std::size_t encode(const WireTelegram& telegram,
                                           std::span<std::byte, kTelegramSizeMax> out) noexcept = 0;
  /// Any bytes may be given. What comes out is well formed.
  [[nodiscard]] virtual std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept = 0;
};

/// A copy of the struct in this machine's layout: for virtual time only, never for a network.
class RawCodec final : public Codec {
 public:
  [[nodiscard]] std::size_t encode(const WireTelegram& telegram,
                                   std::span<std::byte, kTelegramSizeMax> out) noexcept override;
  [[nodiscard]] std::optional<WireTelegram> decode(
      std::span<const std::byte> bytes) noexcept override;
};

}  // namespace palp::link
