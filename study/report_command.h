#pragma once

#include <string>

#include "common/config/command_line.h"

namespace palp::study {

/// `palp-study report`, as given on the command line.
struct StudyReportFlags {
  std::string folder{};
  std::string out{};
  bool unblind{};
  bool pdf{};
};

void declare_report(config::CommandLine& line, StudyReportFlags& flags);
[[nodiscard]] config::ExitStatus run_report(const StudyReportFlags& flags);

}  // namespace palp::study
