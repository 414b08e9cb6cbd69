#include "study/journal.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace palp::study {

Result<Journal> Journal::open(const std::string& path, std::size_t whole) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) return fail_to_reach("cannot write " + path + ": " + std::strerror(errno));
  Journal journal{descriptor, path};
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return fail_to_reach(path + " is being written by another palp-study");
  }
  const auto end = static_cast<off_t>(whole);
  if (::ftruncate(descriptor, end) != 0 || ::lseek(descriptor, end, SEEK_SET) < 0) {
    return fail_to_reach("cannot write " + path + ": " + std::strerror(errno));
  }
  return journal;
}

Journal::Journal(Journal&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)}, path_{std::move(other.path_)} {}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> Journal::add(std::string_view line) {
  while (!line.empty()) {
    const ssize_t taken = ::write(descriptor_, line.data(), line.size());
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return fail_to_reach("cannot write " + path_ + ": " + std::strerror(errno));
    line.remove_prefix(static_cast<std::size_t>(taken));
  }
  if (::fdatasync(descriptor_) != 0) {
    return fail_to_reach("cannot write " + path_ + ": " + std::strerror(errno));
  }
  return {};
}

}  // namespace palp::study
