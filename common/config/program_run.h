#pragma once

#include <functional>
#include <optional>

#include "common/config/command_line.h"
#include "common/core/result.h"

namespace palp::config {

/// Whether a report may be written to that file; the sentence says why not.
using MayReport = std::function<Result<void>(const std::string& file)>;

/// A whole program: parses, looks at the files to be written, then `body` does what was
/// chosen, then leave(); an exception is a CannotOpen. Where `may_report` refuses the report that
/// was asked for nothing runs, and none is written, of a failure neither. @returns what main()
/// returns.
[[nodiscard]] int run_program(CommandLine& line,
                              int argc,
                              const char* const* argv,
                              const std::function<ExitStatus()>& body,
                              const MayReport& may_report = {});

/// After parse(): where an output would take the place of a file that must stay, or the report that
/// was asked for cannot be written.
[[nodiscard]] std::optional<ExitStatus> closed_output(const CommandLine& line);

/// leave(); bad input and what cannot be opened go into the report that was asked for too.
[[nodiscard]] int leave(const CommandLine& line, const ExitStatus& exit_status);

}  // namespace palp::config
