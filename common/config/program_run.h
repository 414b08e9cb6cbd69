#pragma once

#include <functional>

#include "common/config/command_line.h"

namespace palp::config {

/// A whole program: parses, then `body` does what was chosen, then leave(); an exception is a
/// CannotOpen. @returns what main() returns.
[[nodiscard]] int run_program(CommandLine& line,
                              int argc,
                              const char* const* argv,
                              const std::function<ExitStatus()>& body);

/// leave(); bad input and what cannot be opened go into the report that was asked for too.
[[nodiscard]] int leave(const CommandLine& line, const ExitStatus& exit_status);

}  // namespace palp::config
