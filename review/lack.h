#pragma once

#include <string>

#include "common/record/session_reader.h"

namespace palp::review {

/// The metadata record that `palp-review recover` leaves in what it writes.
inline constexpr const char* kRecoveredRecord = "palp.recovered";

/// What a session file lacks, in words that follow "the file "; empty: nothing. All of it was read.
[[nodiscard]] std::string lack_of(const record::SessionReader& reader);

}  // namespace palp::review
