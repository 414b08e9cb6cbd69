#include "common/link/codec_control.h"

#include <algorithm>
#include <string_view>

#include "common/core/check.h"
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
               .git = printable(message.git(), kNameSizeMax)};
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
