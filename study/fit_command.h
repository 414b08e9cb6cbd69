#pragma once

#include <cstdint>
#include <string>

#include "common/config/command_line.h"
#include "study/answers_file.h"
#include "study/psychometric.h"

namespace palp::study {

/// `palp-study fit`, as given on the command line.
struct FitFlags {
  std::string file{};
  std::uint64_t intervals{2};
  bool two_sided{};
  std::string curve{};  ///< empty: none beside the observer's
  std::string report{};
};

void declare_fit(config::CommandLine& line, FitFlags& flags);
[[nodiscard]] config::ExitStatus run_fit(const FitFlags& flags);

/// A table for people and the JSON of schema palp.study_fit/1.
struct FitStatement {
  std::string text;
  std::string report;
};
[[nodiscard]] Result<FitStatement> fit_statement(const AnswersFile& file, const FitFlags& flags);

}  // namespace palp::study
