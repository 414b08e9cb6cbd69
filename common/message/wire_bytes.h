#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/message/limits.h"
#include "common/message/telegram.h"

/// Message Telegram of proto/link.proto, field by field; what fields say of each other is the
/// codec's (common/link). Thread: any; allocates nothing.
namespace palp::message {

/// @returns bytes written.
std::size_t write_wire(const WireTelegram& telegram,
                       std::span<std::byte, kTelegramSizeMax> out) noexcept;

/// Any bytes may be given; `to` is as made. `seen`: bit n says that field n was there.
/// @returns false where they are no such message, have an unknown field, or one twice.
bool read_wire(std::span<const std::byte> bytes, WireTelegram& to, std::uint64_t& seen) noexcept;

/// True where every number keeps its own limits.
[[nodiscard]] bool in_wire_range(const WireTelegram& telegram) noexcept;

/// What later datagrams repeat of a sample: all, but of payloads only those whose list says so.
[[nodiscard]] PortSample for_repetition(const PortSample& sample) noexcept;
/// True for what for_repetition() leaves as it is.
[[nodiscard]] bool is_for_repetition(const PortSample& sample) noexcept;

}  // namespace palp::message
