#pragma once

#include <string>

#include "common/config/command_line.h"
#include "common/config/exit_code.h"
#include "common/core/result.h"

namespace palp::site_program {

/// How a program ended and what scripts and people are told of it.
struct ExitStatus {
  config::ExitCode code{};
  std::string outcome;  ///< a word or two that scripts may compare: "completed", "peer lost"
  std::string reason;   ///< one sentence; empty: nothing to add
};

[[nodiscard]] inline ExitStatus bad_input(std::string sentence) {
  return {config::ExitCode::BadInput, "bad input", std::move(sentence)};
}
[[nodiscard]] inline ExitStatus cannot_start(std::string sentence) {
  return {config::ExitCode::CannotOpen, "cannot start", std::move(sentence)};
}

/// Of what was wrong, or could not be reached at all, before the session.
[[nodiscard]] inline ExitStatus exit_status_of(const Error& error) {
  return error.unreachable ? cannot_start(error.text) : bad_input(error.text);
}

/// Of a command line that was no order to begin.
[[nodiscard]] inline ExitStatus exit_status_of(const config::ExitStatus& refusal) {
  return refusal.code == config::ExitCode::CannotOpen ? cannot_start(refusal.text)
                                                      : bad_input(refusal.text);
}

}  // namespace palp::site_program
