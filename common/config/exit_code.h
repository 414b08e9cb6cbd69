#pragma once

namespace palp::config {

/// What every program says when it ends; scripts rely on it.
enum class ExitCode : int {
  Done = 0,        ///< done, all checks held
  Missed = 1,      ///< ran, but a target or check was missed; the report says which
  BadInput = 2,    ///< flag, field or file content; one sentence: what, the value, the limit
  CannotOpen = 3,  ///< something could not be opened, installed or reached
  CutShort = 4,    ///< session cut short: peer lost, emergency stop, aborted by the user
};

/// What main() returns.
[[nodiscard]] constexpr int exit_value(ExitCode code) noexcept { return static_cast<int>(code); }

}  // namespace palp::config
