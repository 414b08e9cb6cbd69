#include "common/config/program_run.h"

#include <exception>

#include "common/config/report.h"

namespace palp::config {

int run_program(CommandLine& line,
                int argc,
                const char* const* argv,
                const std::function<Ending()>& body) {
  std::optional<Ending> ending = line.parse(argc, argv);
  try {
    if (!ending) ending = body();
  } catch (const std::exception& failure) {
    ending = refusal(line.program(), {.text = failure.what(), .unreachable = true});
  }
  return leave(line, *ending);
}

int leave(const CommandLine& line, const Ending& ending) {
  const bool failed = ending.code == ExitCode::BadInput || ending.code == ExitCode::CannotOpen;
  const CommandLine::AskedReport asked = line.asked_report();
  if (failed && !asked.file.empty()) {
    // That it cannot be written either is not worth a second sentence.
    (void)write_whole_file(asked.file, failure_report(asked.schema, ending));
  }
  return leave(ending);
}

}  // namespace palp::config
