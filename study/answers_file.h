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

/// All that a table holds.
struct AnswersFile {
  std::vector<ConditionAnswers> conditions{};
  bool delays{};  ///< levels are delays [ms]
};

/// A table of trials as BIDS has it: tab-separated, the first line names the columns. `level_ln`
/// [-] or `level_ms`, and `correct` (0 or 1; two-sided tasks: 1 where the second seemed stiffer)
/// must be there; `condition` splits the trials; rows whose `trial_type` is "practice" are left
/// out, as are rows where `correct` is "n/a". Other columns are skipped, but those by which
/// rankings and searches are known: chance gives those other answers than a choice of intervals.
/// Conditions come in the order of the file. `name` is what the sentences call the file. Pure.
[[nodiscard]] Result<AnswersFile> parse_answers(std::string_view text, const std::string& name);

}  // namespace palp::study
