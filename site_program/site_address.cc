#include "site_program/site_address.h"

#include "common/io/secure/room_key.h"

namespace palp::site_program {

tl::expected<HostAndPort, ExitStatus> site_address(const std::string& flag,
                                                   const std::string& text,
                                                   const settings::ProtectionSettings& protection,
                                                   std::uint16_t port_min) {
  if (text.empty()) {
    return tl::unexpected{bad_input(flag + " is missing, an address such as 127.0.0.1:9000")};
  }
  const Result<HostAndPort> place = parse_host_and_port(text, port_min);
  if (!place) {
    return tl::unexpected{bad_input(flag + ": " + place.error().text)};
  }
  if (protection.insecure && !protection.identity.empty()) {
    return tl::unexpected{bad_input("--identity and --insecure exclude each other")};
  }
  if (!protection.insecure && protection.identity.empty()) {
    return tl::unexpected{
        bad_input("--identity is missing, a folder with certificate and key ('palp-surgeon "
                  "certificates' makes one for each site); --insecure does without, on loopback "
                  "addresses only")};
  }
  const Result<io::Endpoint> found = io::resolve(*place);
  if (!found) {
    return tl::unexpected{cannot_start(flag + ": " + found.error().text)};
  }
  if (protection.insecure && !found->loopback()) {
    return tl::unexpected{
        bad_input(flag + " " + text +
                  " is not a loopback address, and --insecure is refused anywhere else: everybody "
                  "on the way could move the stage")};
  }
  return *place;
}

tl::expected<std::optional<MeetingPlace>, ExitStatus> meeting_place(
    const std::string& own,
    const std::string& text,
    const settings::ProtectionSettings& protection) {
  const auto refused = [](const std::string& sentence) {
    return tl::unexpected{bad_input(sentence)};
  };
  if (protection.through.empty() && protection.room.empty()) return std::nullopt;
  if (protection.through.empty()) return refused("--room is that of a relay; --through is missing");
  if (protection.room.empty()) return refused("--through needs --room, the same at both sites");
  if (protection.insecure) {
    return refused("--insecure is refused with --through: a relay reads what is not sealed");
  }
  if (own == "--peer" && !text.empty()) return refused("--peer and --through exclude each other");
  const auto relay = site_address("--through", protection.through, protection, 1);
  if (!relay) return tl::unexpected{relay.error()};
  if (const auto key = io::RoomKey::from_name(protection.room); !key) {
    return refused("--room: " + key.error().text);
  }
  return MeetingPlace{*relay, protection.room};
}

}  // namespace palp::site_program
