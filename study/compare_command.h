#pragma once

#include <string>

#include "common/config/command_line.h"
#include "study/data_fit.h"

namespace palp::study {

/// `palp-study fit FOLDER`: of a whole study. `report`: a JSON file besides; empty: none.
[[nodiscard]] config::ExitStatus run_fit_study(const std::string& folder,
                                               const std::string& report);

/// `palp-study compare FOLDER`.
void declare_compare(config::CommandLine& line, std::string& folder);
[[nodiscard]] config::ExitStatus run_compare(const std::string& folder);

/// A table for people.
[[nodiscard]] std::string pairs_text(const std::vector<ConditionPair>& pairs,
                                     const std::vector<std::string>& names,
                                     Measure measure);

}  // namespace palp::study
