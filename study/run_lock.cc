#include "study/run_lock.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/core/printable.h"

namespace palp::study {
namespace {

tl::unexpected<Error> cannot_lock(const std::string& path) {
  return fail_to_reach("cannot lock " + printable(path) + ": " + std::strerror(errno));
}

}  // namespace

Result<RunLock> RunLock::open(const std::string& path) {
  // Without O_NONBLOCK the name of a pipe would make this wait.
  const int descriptor =
      ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, 0644);
  if (descriptor < 0) return cannot_lock(path);
  return RunLock{descriptor, path};
}

RunLock::RunLock(RunLock&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)}, path_{std::move(other.path_)} {}

RunLock::~RunLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool RunLock::alone() { return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0; }

Result<void> RunLock::beside_others() {
  while (::flock(descriptor_, LOCK_SH) != 0) {
    if (errno != EINTR) return cannot_lock(path_);
  }
  return {};
}

}  // namespace palp::study
