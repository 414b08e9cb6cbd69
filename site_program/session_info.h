#pragma once

#include <cstdint>
#include <string>

#include "common/config/document.h"
#include "common/link/session.h"
#include "common/record/session_writer.h"

namespace palp::site_program {

/// What the session file of a site in real time says of itself: program, version, commit, protocol,
/// seed, kernel; and, attached, the effective configuration.
[[nodiscard]] record::SessionInfo session_info(link::Role role,
                                               const std::string& program,
                                               std::uint64_t seed,
                                               const config::Document& document);

}  // namespace palp::site_program
