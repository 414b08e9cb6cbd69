#pragma once

#include <span>
#include <string>

#include "common/core/result.h"
#include "study/block.h"
#include "study/trial_row.h"

namespace palp::study {

/// Tells a block the answers that were written down. Each row must be the trial that the schedule
/// and the answers before it ask for, with what is believed after it: else the file is not of this
/// study, or was changed. The sentence names the trial. Pure.
[[nodiscard]] Result<void> replay_rows(Block& block,
                                       std::span<const TrialRow> rows,
                                       const std::string& code);

}  // namespace palp::study
