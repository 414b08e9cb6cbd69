#include "common/config/program_run.h"

#include <exception>

#include "common/config/report.h"

namespace palp::config {

std::optional<ExitStatus> closed_output(const CommandLine& line) {
  if (const auto clash = line.clash()) {
    return ExitStatus{ExitCode::BadInput, line.program() + ": " + *clash};
  }
  const CommandLine::AskedReport asked = line.asked_report();
  if (asked.file.empty()) return std::nullopt;
  const auto can = can_write_file(asked.file);
  if (can) return std::nullopt;
  return ExitStatus{ExitCode::CannotOpen, line.program() + ": --report: " + can.error().text};
}

int run_program(CommandLine& line,
                int argc,
                const char* const* argv,
                const std::function<ExitStatus()>& body,
                const MayReport& may_report) {
  std::optional<ExitStatus> exit_status = line.parse(argc, argv);
  try {
    const std::string report = line.asked_report().file;
    if (may_report && !report.empty()) {
      if (const auto may = may_report(report); !may) {
        // A line that is wrong besides is told first.
        return leave(exit_status.value_or(
            ExitStatus{ExitCode::BadInput, line.program() + ": --report: " + may.error().text}));
      }
    }
    if (!exit_status) exit_status = closed_output(line);
    if (!exit_status) exit_status = body();
  } catch (const std::exception& failure) {
    exit_status = refusal(line.program(), {.text = failure.what(), .unreachable = true});
  }
  return leave(line, *exit_status);
}

int leave(const CommandLine& line, const ExitStatus& exit_status) {
  const bool failed =
      exit_status.code == ExitCode::BadInput || exit_status.code == ExitCode::CannotOpen;
  if (!failed) return leave(exit_status);
  const CommandLine::AskedReport asked = line.asked_report();
  if (!asked.file.empty() && !asked.clash) {
    // That it cannot be written either is not worth a second sentence.
    (void)write_whole_file(asked.file, failure_report(asked.schema, exit_status));
  }
  return leave(exit_status);
}

}  // namespace palp::config
