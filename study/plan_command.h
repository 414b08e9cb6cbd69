#pragma once

#include <string>

#include "common/config/command_line.h"
#include "study/study_file.h"

namespace palp::study {

/// `palp-study plan`, as given on the command line.
struct PlanFlags {
  std::string file{};
  std::string folder{};
};

void declare_plan(config::CommandLine& line, PlanFlags& flags);
/// `made_by`: version and commit of this program.
[[nodiscard]] config::ExitStatus run_plan(const PlanFlags& flags, const std::string& made_by);

/// What is registered before anybody is asked: question, conditions, measure, numbers and why,
/// order, exclusions, analysis, seed, fingerprints.
[[nodiscard]] std::string preregistration(const Study& study,
                                          const std::string& study_sha256,
                                          const std::string& schedule_sha256,
                                          const std::string& made_by);

}  // namespace palp::study
