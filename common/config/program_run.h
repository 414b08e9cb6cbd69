#pragma once

#include <functional>
#include <optional>

#include "common/config/command_line.h"

namespace palp::config {

/// A whole program: parses, looks whether a report can be written, then `body` does what was
/// chosen, then leave(); an exception is a CannotOpen. @returns what main() returns.
[[nodiscard]] int run_program(CommandLine& line,
                              int argc,
                              const char* const* argv,
                              const std::function<ExitStatus()>& body);

/// After parse(): where the report that was asked for cannot be written, or would take the place of
/// another file of the command.
[[nodiscard]] std::optional<ExitStatus> closed_report(const CommandLine& line);

/// leave(); bad input and what cannot be opened go into the report that was asked for too.
[[nodiscard]] int leave(const CommandLine& line, const ExitStatus& exit_status);

}  // namespace palp::config
