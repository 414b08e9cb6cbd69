#include "study/journal.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/core/printable.h"
#include "study/data_set.h"

namespace palp::study {
namespace {

tl::unexpected<Error> cannot(const char* what, const std::string& path) {
  return fail_to_reach(std::string{"cannot "} + what + ' ' + printable(path) + ": " +
                       std::strerror(errno));
}

}  // namespace

Result<Journal> Journal::open(const std::string& path, Readers readers) {
  // Without O_NONBLOCK the name of a pipe would make this wait.
  const int descriptor = ::open(path.c_str(),
                                O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY,
                                readers == Readers::Owner ? 0600 : 0644);
  if (descriptor < 0) return cannot("write", path);
  Journal journal{descriptor, path};
  struct stat there {};
  if (::fstat(descriptor, &there) != 0) return cannot("read", path);
  if (!S_ISREG(there.st_mode)) return fail_to_reach(printable(path) + " is no regular file");
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    return fail_to_reach(path + " is being written by another palp-study");
  }
  if (auto read = journal.read(); !read) return tl::unexpected(read.error());
  return journal;
}

Result<void> Journal::read() {
  std::array<char, 65536> block{};
  while (true) {
    const ssize_t count = ::read(descriptor_, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot("read", path_);
    if (count == 0) return {};
    text_.append(block.data(), static_cast<std::size_t>(count));
    if (text_.size() > kTableMax) return fail_to_reach(printable(path_) + " is too long");
  }
}

Journal::Journal(Journal&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)},
      path_{std::move(other.path_)},
      text_{std::move(other.text_)} {}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> Journal::cut(std::size_t whole) {
  if (whole >= text_.size()) return {};
  auto kept = open(path_ + ".cut");
  if (!kept) return tl::unexpected(kept.error());
  if (auto added = kept->add(text_.substr(whole) + '\n'); !added) return added;
  const auto end = static_cast<off_t>(whole);
  if (::ftruncate(descriptor_, end) != 0 || ::lseek(descriptor_, end, SEEK_SET) < 0) {
    return cannot("write", path_);
  }
  text_.resize(whole);
  return {};
}

Result<void> Journal::add(std::string_view line) {
  while (!line.empty()) {
    const ssize_t taken = ::write(descriptor_, line.data(), line.size());
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return cannot("write", path_);
    line.remove_prefix(static_cast<std::size_t>(taken));
  }
  if (::fdatasync(descriptor_) != 0) return cannot("write", path_);
  return {};
}

}  // namespace palp::study
