#include "common/config/exit_status.h"

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <system_error>

#include "common/core/printable.h"

namespace palp::config {
namespace {

/// Why something that was printed is lost; empty: nothing, or told before.
std::string lost_output() {
  errno = 0;
  const bool flushed = std::cout.flush().good() && std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return {};
  std::clearerr(stdout);
  std::cout.clear();
  return "standard output could not be written" +
         (errno == 0 ? std::string{} : ": " + std::generic_category().message(errno));
}

}  // namespace

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
  const std::string lost = lost_output();
  if (lost.empty()) return exit_value(exit_status.code);
  (void)std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, lost.c_str());
  return exit_value(exit_status.code == ExitCode::Done ? ExitCode::CannotOpen : exit_status.code);
}

}  // namespace palp::config
