#pragma once

#include <string>
#include <vector>

#include "lab/plan/batch.h"

namespace palp::lab {

/// What the set `gestures` says, as a table of Markdown: gesture and round trip by grip. A cell
/// whose hand or tip was unstable ends with `!`; a dash: nothing was felt that could be judged.
[[nodiscard]] std::string gesture_table(const Plan& plan, const std::vector<CaseResult>& results);

}  // namespace palp::lab
