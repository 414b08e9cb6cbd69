#include "common/link/header.h"

#include <utility>

#include "common/core/check.h"
#include "common/link/transport.h"
#include "common/message/limits.h"

namespace palp::link {
namespace {

// Without a loop the compiler sees what it is: one number, its bytes in the other order.

template <class Unsigned, std::size_t... kAt>
void put(Unsigned value, std::span<std::byte> out, std::index_sequence<kAt...> /*all*/) noexcept {
  ((out[kAt] = static_cast<std::byte>(value >> (8U * (sizeof value - 1U - kAt)) & 0xFFU)), ...);
}

template <class Unsigned>
void put(Unsigned value, std::span<std::byte> out) noexcept {
  put(value, out, std::make_index_sequence<sizeof value>{});
}

template <class Unsigned, std::size_t... kAt>
Unsigned take(std::span<const std::byte> in, std::index_sequence<kAt...> /*all*/) noexcept {
  return static_cast<Unsigned>(
      ((std::to_integer<std::uint64_t>(in[kAt]) << (8U * (sizeof(Unsigned) - 1U - kAt))) | ...));
}

template <class Unsigned>
Unsigned take(std::span<const std::byte> in) noexcept {
  return take<Unsigned>(in, std::make_index_sequence<sizeof(Unsigned)>{});
}

constexpr bool is_ours(unsigned type) noexcept {
  return type <= static_cast<unsigned>(PacketType::Close) ||
         type == static_cast<unsigned>(PacketType::Media);
}

}  // namespace

void pack_header(const Header& header, std::span<std::byte, kHeaderSize> out) noexcept {
  PALP_CHECK(is_ours(static_cast<unsigned>(header.type)), "a packet type of ours");
  PALP_CHECK(header.key <= kKeyMax, "a key id has two bits");
  PALP_CHECK(header.number <= message::kNumberMax, "packet numbers never wrap");
  out[0] = static_cast<std::byte>(kHeaderVersion << 4U | static_cast<unsigned>(header.type));
  out[1] = static_cast<std::byte>(header.key << 6U);
  put(header.length, out.subspan(2, 2));
  put(header.connection, out.subspan(4, 4));
  put(header.number, out.subspan(8, 8));
}

std::optional<Header> parse_clear_part(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() < kHeaderSize || datagram.size() > kDatagramSizeMax) return std::nullopt;
  const auto first = std::to_integer<unsigned>(datagram[0]);
  const auto second = std::to_integer<unsigned>(datagram[1]);
  if (first >> 4U != kHeaderVersion) return std::nullopt;
  if (!is_ours(first & 0x0FU)) return std::nullopt;
  if ((second & 0x3FU) != 0) return std::nullopt;  // flags: all reserved
  const Header header{.type = static_cast<PacketType>(first & 0x0FU),
                      .key = static_cast<std::uint8_t>(second >> 6U),
                      .length = take<std::uint16_t>(datagram.subspan(2, 2)),
                      .connection = 0,
                      .number = 0};
  if (header.length != datagram.size() - kHeaderSize) return std::nullopt;
  return header;
}

std::optional<Header> parse_hidden_part(Header clear, HiddenPart hidden) noexcept {
  clear.connection = take<std::uint32_t>(hidden.first(4));
  clear.number = take<std::uint64_t>(hidden.subspan(4));
  if (clear.number > message::kNumberMax) return std::nullopt;
  return clear;
}

std::optional<Header> parse_header(std::span<const std::byte> datagram) noexcept {
  const std::optional<Header> clear = parse_clear_part(datagram);
  if (!clear) return std::nullopt;
  return parse_hidden_part(*clear, datagram.first<kHeaderSize>().subspan<kClearSize>());
}

}  // namespace palp::link
