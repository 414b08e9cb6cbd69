#include "common/config/ending.h"

#include <cstdio>

namespace palp::config {

Ending refusal(const std::string& program, const Error& fault) {
  return {fault.unreachable ? ExitCode::CannotOpen : ExitCode::BadInput,
          program + ": " + fault.text};
}

int leave(const Ending& ending) {
  if (!ending.text.empty()) {
    const char* const rest = ending.text.back() == '\n' ? "" : "\n";
    (void)std::fputs((ending.text + rest).c_str(), ending.code == ExitCode::Done ? stdout : stderr);
  }
  return exit_status(ending.code);
}

}  // namespace palp::config
