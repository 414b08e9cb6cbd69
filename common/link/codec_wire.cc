#include "common/link/codec_wire.h"

#include <cstdint>

#include "common/message/wire_bytes.h"

namespace palp::link {
namespace {

// Fields of message Telegram, as bits of what was read.
constexpr std::uint64_t kNeeded = 1U << 6U | 1U << 7U;  // site, sample
constexpr std::uint64_t kFirstEarlier = 1U << 8U;
constexpr std::uint64_t kSecondEarlier = 1U << 9U;

bool read_telegram(std::span<const std::byte> bytes, WireTelegram& telegram) noexcept {
  std::uint64_t seen = 0;
  if (!message::read_wire(bytes, telegram, seen)) return false;
  if ((seen & kNeeded) != kNeeded) return false;
  if ((seen & kFirstEarlier) != 0) telegram.older_count = 1;
  if ((seen & kSecondEarlier) != 0) {
    if (telegram.older_count == 0) return false;
    telegram.older_count = 2;
  }
  return well_formed(telegram);
}

}  // namespace

std::size_t WireCodec::encode(const WireTelegram& telegram,
                              std::span<std::byte, message::kTelegramSizeMax> out) noexcept {
  return well_formed(telegram) ? message::write_wire(telegram, out) : 0;
}

std::optional<WireTelegram> WireCodec::decode(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() > message::kTelegramSizeMax) return std::nullopt;
  std::optional<WireTelegram> telegram{std::in_place};
  if (!read_telegram(bytes, *telegram)) telegram.reset();
  return telegram;
}

}  // namespace palp::link
