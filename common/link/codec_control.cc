#include "common/link/codec_control.h"

#include <algorithm>
#include <string_view>

#include "common/core/check.h"
#include "common/message/device_bytes.h"
#include "proto/link.pb.h"

namespace palp::link {
namespace {

std::string printable(std::string_view text, std::size_t size_max) {
  std::string clean{text.substr(0, size_max)};
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

template <class Message>
ControlBytes serialize(const Message& message) {
  ControlBytes out;
  out.size = message.ByteSizeLong();
  PALP_CHECK(out.size <= out.bytes.size(), "control messages are short");
  message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(out.bytes.data()));
  return out;
}

template <class Message>
bool parse(std::span<const std::byte> bytes, Message& message) {
  return bytes.size() <= kControlSizeMax &&
         message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

void put(const DeviceFacts& facts, shared::Devices& out) {
  std::array<std::byte, message::kDevicesSizeMax> room{};
  const std::size_t size = message::write_devices(facts, room);
  const bool read_back = out.ParseFromArray(room.data(), static_cast<int>(size));
  PALP_CHECK(read_back, "the list is that of the schema");
}

/// What protobuf has read is read again; the numbers may be anything.
DeviceFacts facts_of(const shared::Devices& in) {
  DeviceFacts facts;
  const std::string bytes = in.SerializeAsString();
  if (!message::read_devices(std::as_bytes(std::span{bytes}), facts)) return {};
  return facts;
}

}  // namespace

ControlBytes encode(const Hello& hello) {
  wire::Hello message;
  message.set_protocol_version(hello.protocol_version);
  message.set_role(hello.role == Role::Surgeon ? wire::SURGEON : wire::PATIENT);
  message.set_session_id(hello.session_id);
  message.set_peer_session_id(hello.peer_session_id);
  message.set_connection_id(hello.connection_id);
  message.set_settings_hash(hello.settings_hash);
  message.set_coupling(printable(hello.coupling, kNameSizeMax));
  message.set_git(printable(hello.git, kNameSizeMax));
  put(hello.devices, *message.mutable_devices());
  return serialize(message);
}

ControlBytes encode(const Bye& bye) {
  wire::Bye message;
  message.set_session_id(bye.session_id);
  message.set_peer_session_id(bye.peer_session_id);
  message.set_reason(static_cast<wire::Bye::Reason>(bye.reason));
  message.set_text(printable(bye.text, kTextSizeMax));
  return serialize(message);
}

std::optional<Hello> decode_hello(std::span<const std::byte> bytes) {
  wire::Hello message;
  if (!parse(bytes, message)) return std::nullopt;
  if (message.role() != wire::SURGEON && message.role() != wire::PATIENT) return std::nullopt;
  if (message.session_id() == 0) return std::nullopt;
  if (message.coupling().size() > kNameSizeMax || message.git().size() > kNameSizeMax) {
    return std::nullopt;
  }
  return Hello{.protocol_version = message.protocol_version(),
               .role = message.role() == wire::SURGEON ? Role::Surgeon : Role::Patient,
               .session_id = message.session_id(),
               .peer_session_id = message.peer_session_id(),
               .connection_id = message.connection_id(),
               .settings_hash = message.settings_hash(),
               .coupling = printable(message.coupling(), kNameSizeMax),
               .git = printable(message.git(), kNameSizeMax),
               .devices = facts_of(message.devices())};
}

std::optional<Bye> decode_bye(std::span<const std::byte> bytes) {
  wire::Bye message;
  if (!parse(bytes, message)) return std::nullopt;
  if (message.reason() < 0 || message.reason() >= kByeReasonCount) return std::nullopt;
  if (message.text().size() > kTextSizeMax) return std::nullopt;
  return Bye{.session_id = message.session_id(),
             .peer_session_id = message.peer_session_id(),
             .reason = static_cast<ByeReason>(message.reason()),
             .text = printable(message.text(), kTextSizeMax)};
}

}  // namespace palp::link
