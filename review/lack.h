#pragma once

#include <optional>
#include <string>

#include "common/record/session_reader.h"

namespace palp::review {

/// The metadata record that `palp-review recover` leaves in what it writes.
inline constexpr const char* kRecoveredRecord = "palp.recovered";

/// The first fault of a file, in one sentence; nullopt: it is whole, closed, and every message
/// decodes. All of it was read.
[[nodiscard]] std::optional<std::string> fault_of(const record::SessionReader& reader);

/// What a session file lacks, in words that follow "the file "; empty: nothing, and fault_of() says
/// nothing either. All of it was read.
[[nodiscard]] std::string lack_of(const record::SessionReader& reader);

}  // namespace palp::review
