#pragma once

#include <functional>
#include <optional>

#include "common/config/command_line.h"

namespace palp::config {

/// A whole program: parses, looks at the files to be written, then `body` does what was
/// chosen, then leave(); an exception is a CannotOpen. @returns what main() returns.
[[nodiscard]] int run_program(CommandLine& line,
                              int argc,
                              const char* const* argv,
                              const std::function<ExitStatus()>& body);

/// After parse(): where an output would take the place of a file that must stay, or the report that
/// was asked for cannot be written.
[[nodiscard]] std::optional<ExitStatus> closed_output(const CommandLine& line);

/// leave(); bad input and what cannot be opened go into the report that was asked for too.
[[nodiscard]] int leave(const CommandLine& line, const ExitStatus& exit_status);

}  // namespace palp::config
