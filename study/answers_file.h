#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "study/psychometric.h"

namespace palp::study {

/// What was answered under one condition, trial by trial.
struct ConditionAnswers {
  std::string condition;         ///< empty: the file names none
  std::vector<Answers> answers;  ///< pooled
};

/// A table of trials as BIDS has it: tab-separated, the first line names the columns. `level_ln`
/// [-] and `correct` (0 or 1; two-sided tasks: 1 where the second seemed stiffer) must be there;
/// `condition` splits the trials; rows whose `trial_type` is "practice" are left out, as are rows
/// where `correct` is "n/a". Other columns are skipped. Conditions come in the order of the file.
/// `name` is what the sentences call the file. Pure.
[[nodiscard]] Result<std::vector<ConditionAnswers>> parse_answers(std::string_view text,
                                                                  const std::string& name);

}  // namespace palp::study
