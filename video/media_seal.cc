#include "video/media_seal.h"

#include <utility>

#include "common/link/aead_protection.h"

namespace palp::video {

using link::Header;
using link::PacketType;

MediaKeys media_keys(const std::optional<link::PlaneKeys>& exported, link::Role role) {
  if (exported) {
    return {.protection = std::make_unique<link::AeadProtection>(exported->keys),
            .send_connection = exported->send_connection,
            .receive_connection = exported->receive_connection};
  }
  constexpr std::uint32_t kToPatient = 1;
  constexpr std::uint32_t kToSurgeon = 2;
  const bool surgeon = role == link::Role::Surgeon;
  return {.protection = std::make_unique<link::PlainProtection>(),
          .send_connection = surgeon ? kToPatient : kToSurgeon,
          .receive_connection = surgeon ? kToSurgeon : kToPatient};
}

Bytes MediaSeal::seal(std::span<const std::byte> payload) {
  Bytes datagram(link::kHeaderSize + payload.size() + keys_.protection->overhead());
  const Header header{
      .type = PacketType::Media, .connection = keys_.send_connection, .number = next_number_++};
  datagram.resize(keys_.protection->seal(header, payload, datagram));
  return datagram;
}

std::optional<MediaSeal::Opened> MediaSeal::open(std::span<const std::byte> datagram) {
  const auto refuse = [this] {
    ++refused_;
    return std::nullopt;
  };
  const auto header = keys_.protection->read_header(datagram);
  if (!header || header->type != PacketType::Media) return refuse();
  if (header->connection != keys_.receive_connection) return refuse();
  if (window_.judge(header->number) != link::ReplayWindow::Verdict::New) return refuse();
  Opened opened{.payload = Bytes(datagram.size()), .newest = false};
  const auto size = keys_.protection->open(*header, datagram, opened.payload);
  if (!size) return refuse();
  opened.payload.resize(*size);
  opened.newest = window_.empty() || header->number > window_.newest();
  window_.mark(header->number);
  return opened;
}

}  // namespace palp::video
