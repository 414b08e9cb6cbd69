#include "common/link/codec.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <type_traits>

#include "common/message/wire_bytes.h"

namespace palp::link {
namespace {

bool nothing_acknowledged(const WireTelegram& telegram) noexcept {
  return telegram.hold_us == 0 && telegram.newest_number == 0 && telegram.before_newest == 0;
}

}  // namespace

bool well_formed(const WireTelegram& telegram) noexcept {
  if (telegram.older_count > telegram.older.size()) return false;
  if (!message::in_wire_range(telegram)) return false;
  if (telegram.echo_ns == message::kNothingHeard && !nothing_acknowledged(telegram)) return false;
  const auto older = std::span{telegram.older}.first(telegram.older_count);
  return std::all_of(older.begin(), older.end(), message::is_for_repetition);
}

std::size_t RawCodec::encode(const WireTelegram& telegram,
                             std::span<std::byte, message::kTelegramSizeMax> out) noexcept {
  static_assert(std::is_trivially_copyable_v<WireTelegram>);
  static_assert(sizeof(WireTelegram) <= message::kTelegramSizeMax);
  if (!well_formed(telegram)) return 0;
  std::memcpy(out.data(), &telegram, sizeof telegram);
  return sizeof telegram;
}

std::optional<WireTelegram> RawCodec::decode(std::span<const std::byte> bytes) noexcept {
  WireTelegram telegram;
  if (bytes.size() != sizeof telegram) return std::nullopt;
  std::memcpy(&telegram, bytes.data(), sizeof telegram);
  if (!well_formed(telegram)) return std::nullopt;
  return telegram;
}

}  // namespace palp::link
