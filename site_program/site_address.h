#pragma once

#include <cstdint>
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

}  // namespace palp::site_program
