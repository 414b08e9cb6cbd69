#pragma once

#include <string>

#include "common/core/result.h"
#include "review/time_line.h"

namespace palp::review {

/// A session as a scenario of the lab: both sites' settings, the recorded hand of the file
/// `surgeon_path` in place of the master, and a path with the delay, jitter and loss that the
/// session measured. The lab plays it under another coupling, estimator or network: there stage,
/// tissue and hand answer, which no file's can.
/// @returns a sentence where the files do not say enough: no settings, or a tissue that is real.
[[nodiscard]] Result<std::string> scenario_text(const SessionPair& session,
                                                const std::string& surgeon_path);

}  // namespace palp::review
