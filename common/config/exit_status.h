#pragma once

#include <string>

#include "common/config/exit_code.h"
#include "common/core/result.h"

namespace palp::config {

/// Why a program ends before it began, and what it says.
struct ExitStatus {
  ExitCode code{};
  std::string text;
};

/// Prints the text (to standard output if Done, else to standard error; an empty one
/// not at all) and gives main()'s value: Done becomes CannotOpen, with a sentence, where standard
/// output did not take all that the program has printed. Of every program the last act.
[[nodiscard]] int leave(const ExitStatus& exit_status);

/// `program` was given something wrong, or something that cannot be read.
[[nodiscard]] ExitStatus refusal(const std::string& program, const Error& fault);

}  // namespace palp::config
