#pragma once

#include <string>

#include "common/config/exit_code.h"

namespace palp::site_program {

/// How a program ended and what scripts and people are told of it.
struct Ending {
  config::ExitCode code{};
  std::string outcome;  ///< a word or two that scripts may compare: "completed", "peer lost"
  std::string reason;   ///< one sentence; empty: nothing to add
};

[[nodiscard]] inline Ending bad_input(std::string sentence) {
  return {config::ExitCode::BadInput, "bad input", std::move(sentence)};
}
[[nodiscard]] inline Ending cannot_start(std::string sentence) {
  return {config::ExitCode::CannotOpen, "cannot start", std::move(sentence)};
}

}  // namespace palp::site_program
