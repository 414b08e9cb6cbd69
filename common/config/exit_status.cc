#include "common/config/exit_status.h"

#include <cstdio>

#include "common/core/printable.h"

namespace palp::config {

ExitStatus refusal(const std::string& program, const Error& fault) {
  return {fault.unreachable ? ExitCode::CannotOpen : ExitCode::BadInput,
          program + ": " + fault.text};
}

int leave(const ExitStatus& exit_status) {
  if (!exit_status.text.empty()) {
    const char* const rest = exit_status.text.back() == '\n' ? "" : "\n";
    (void)std::fputs(harmless(exit_status.text + rest).c_str(),
                     exit_status.code == ExitCode::Done ? stdout : stderr);
  }
  return exit_value(exit_status.code);
}

}  // namespace palp::config
