#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

/// The 16 bytes in front of every datagram (proto/WIRE.md). The first four are clear; a protection
/// may hide the others. Pure functions.
namespace palp::link {

inline constexpr std::size_t kHeaderSize = 16;     ///< [bytes]
inline constexpr std::size_t kClearSize = 4;       ///< [bytes], of them: never hidden
inline constexpr std::uint8_t kHeaderVersion = 8;  ///< 1 would look like a DTLS record
inline constexpr std::uint8_t kKeyMax = 3;         ///< two bits

/// 4 marks what goes to and from a relay, which is none of these.
enum class PacketType : std::uint8_t { Data, Control, Path, Close, Media = 5 };

struct Header {
  PacketType type{};
  std::uint8_t key{};          ///< id of the key, 0..3
  std::uint16_t length{};      ///< [bytes], all after the header, tag included
  std::uint32_t connection{};  ///< id given out by the receiver, 0: not known yet
  std::uint64_t number{};      ///< of the packet; with keys it makes the nonce
};

/// Big-endian bytes. `header` keeps its limits (PALP_CHECK: it is ours).
void pack_header(const Header& header, std::span<std::byte, kHeaderSize> out) noexcept;

/// @returns nullopt where any field breaks its rule, `length` is not what follows the header, or
/// the datagram is longer than kDatagramSizeMax.
[[nodiscard]] std::optional<Header> parse_header(std::span<const std::byte> datagram) noexcept;

/// Of its first four bytes: type, key id and length; connection and number stay 0.
/// @returns nullopt as parse_header() does.
[[nodiscard]] std::optional<Header> parse_clear_part(std::span<const std::byte> datagram) noexcept;

using HiddenPart = std::span<const std::byte, kHeaderSize - kClearSize>;
/// Connection and number, which were hidden, come to what parse_clear_part() made.
/// @returns nullopt where the number is beyond its limit.
[[nodiscard]] std::optional<Header> parse_hidden_part(Header clear, HiddenPart hidden) noexcept;

}  // namespace palp::link
