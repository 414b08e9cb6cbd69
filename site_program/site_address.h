#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/config/exit_code.h"
#include "common/io/net/endpoint.h"
#include "common/settings/site_settings.h"
#include "site_program/exit_status.h"

namespace palp::site_program {

/// Where to listen or whom to call. With an identity anywhere; with --insecure, where datagrams are
/// neither encrypted nor authenticated, only within this machine. `flag` is what the sentence calls
/// the address. `port_min`: 1 where one calls. May ask the resolver.
[[nodiscard]] tl::expected<HostAndPort, ExitStatus> site_address(
    const std::string& flag,
    const std::string& text,
    const settings::ProtectionSettings& protection,
    std::uint16_t port_min);

/// Where two sites meet instead of one calling the other.
struct MeetingPlace {
  HostAndPort relay;
  std::string room;  ///< a name that gives a RoomKey
};

/// What --through and --room say; nullopt: they say nothing. `own` is the site's flag for an
/// address and `text` its value: the surgeon cannot call both. May ask the resolver.
[[nodiscard]] tl::expected<std::optional<MeetingPlace>, ExitStatus> meeting_place(
    const std::string& own,
    const std::string& text,
    const settings::ProtectionSettings& protection);

}  // namespace palp::site_program
