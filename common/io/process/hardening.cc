#include "common/io/process/hardening.h"

#include <cerrno>

#include <sys/prctl.h>
#include <sys/resource.h>

#include "common/io/process/system_call_filter.h"
#include "common/io/process/system_text.h"

namespace palp::io {
namespace {

/// Off under a sanitizer, which begins a process of its own and looks into this one (CMake).
constexpr bool kFiltersCalls = PALP_FILTER_CALLS != 0;

}  // namespace

std::optional<std::string> harden_process() {
  const auto refused = [](const char* what) {
    return std::string{"this process cannot "} + what + ": " + system_text(errno);
  };
  // Both: the limit is ignored where cores go to a program, the flag where somebody sets it back.
  const rlimit none{0, 0};
  if (::setrlimit(RLIMIT_CORE, &none) != 0) return refused("forbid core files");
  if (::prctl(PR_SET_DUMPABLE, 0, 0, 0, 0) != 0) return refused("hide its memory");
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return refused("give up new rights");
  return kFiltersCalls ? refuse_system_calls() : std::nullopt;
}

}  // namespace palp::io
