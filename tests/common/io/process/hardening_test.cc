#include "common/io/process/hardening.h"

#include <cstdlib>

#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace palp::io {
namespace {

/// What a process of its own exits with after `check`, or the signal that ended it.
template <class Check>
int in_another_process(Check&& check, bool& dumped) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(check());
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  dumped = WIFSIGNALED(status) && WCOREDUMP(status);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(HardeningTest, AProcessThatAbortsLeavesNoCore) {
  bool dumped = true;
  const int ended = in_another_process(
      [] {
        const rlimit large{RLIM_INFINITY, RLIM_INFINITY};
        (void)::setrlimit(RLIMIT_CORE, &large);
        if (harden_process()) return 1;
        std::abort();
      },
      dumped);
  EXPECT_EQ(ended, 128 + SIGABRT);
  EXPECT_FALSE(dumped);
}

TEST(HardeningTest, LimitFlagAndRightsAreGivenUp) {
  bool dumped = false;
  const int ended = in_another_process(
      [] {
        if (harden_process()) return 1;
        rlimit core{1, 1};
        ::getrlimit(RLIMIT_CORE, &core);
        if (core.rlim_cur != 0 || core.rlim_max != 0) return 2;
        if (::prctl(PR_GET_DUMPABLE, 0, 0, 0, 0) != 0) return 3;
        if (::prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) != 1) return 4;
        return 0;
      },
      dumped);
  EXPECT_EQ(ended, 0);
}

// But under a sanitizer, which needs what is refused (PALP_FILTER_CALLS, set by CMake).
TEST(HardeningTest, SystemCallsAreFiltered) {
  bool dumped = false;
  const int mode = in_another_process(
      [] {
        if (harden_process()) return 1;
        return ::prctl(PR_GET_SECCOMP, 0, 0, 0, 0);
      },
      dumped);
  EXPECT_EQ(mode, PALP_FILTER_CALLS != 0 ? SECCOMP_MODE_FILTER : SECCOMP_MODE_DISABLED);
}

}  // namespace
}  // namespace palp::io
