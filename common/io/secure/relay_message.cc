#include "common/io/secure/relay_message.h"

#include <algorithm>

namespace palp::io {
namespace {

constexpr std::size_t kRoomAt = 4;
constexpr std::size_t kCookieAt = kRoomAt + sizeof(RoomId);
constexpr std::size_t kProofAt = kCookieAt + sizeof(RelayMessage::Cookie);
static_assert(kProofAt + sizeof(RoomProof) == RelayMessage::kSize);

}  // namespace

std::optional<RelayMessage> RelayMessage::parse(std::span<const std::byte> datagram) {
  if (datagram.size() != kSize || datagram[0] != kFirstByte) return std::nullopt;
  const auto kind = std::to_integer<std::uint8_t>(datagram[1]);
  const auto role = std::to_integer<std::uint8_t>(datagram[2]);
  const auto detail = std::to_integer<std::uint8_t>(datagram[3]);
  if (kind > static_cast<std::uint8_t>(Kind::Refused) || role > 1 || detail > 1) {
    return std::nullopt;
  }
  RelayMessage message;
  message.kind = static_cast<Kind>(kind);
  message.role = role == 0 ? link::Role::Surgeon : link::Role::Patient;
  message.detail = detail;
  std::ranges::copy(datagram.subspan(kRoomAt, sizeof(RoomId)), message.room.begin());
  std::ranges::copy(datagram.subspan(kCookieAt, sizeof(Cookie)), message.cookie.begin());
  std::ranges::copy(datagram.subspan(kProofAt, sizeof(RoomProof)), message.proof.begin());
  return message;
}

std::array<std::byte, RelayMessage::kSize - sizeof(RoomProof)> RelayMessage::claim()
    const noexcept {
  std::array<std::byte, kSize - sizeof(RoomProof)> bytes{};
  bytes[0] = kFirstByte;
  bytes[1] = static_cast<std::byte>(kind);
  bytes[2] = role == link::Role::Surgeon ? std::byte{0} : std::byte{1};
  bytes[3] = static_cast<std::byte>(detail);
  std::ranges::copy(room, bytes.begin() + kRoomAt);
  std::ranges::copy(cookie, bytes.begin() + kCookieAt);
  return bytes;
}

RelayMessage::Bytes RelayMessage::bytes() const noexcept {
  Bytes bytes{};
  std::ranges::copy(claim(), bytes.begin());
  std::ranges::copy(proof, bytes.begin() + kProofAt);
  return bytes;
}

}  // namespace palp::io
