#include "common/core/whole_file.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "common/core/printable.h"

namespace palp {
namespace {

constexpr int kSilenceMaxMs = 2000;  // [ms]

/// Bytes that were read, 0 at the end, or less with errno set.
ssize_t read_some(int file, std::array<char, 65536>& block) {
  pollfd ready{file, POLLIN, 0};
  const int readable = ::poll(&ready, 1, kSilenceMaxMs);
  if (readable == 0) errno = ETIMEDOUT;
  if (readable <= 0) return -1;
  return ::read(file, block.data(), block.size());
}

}  // namespace

Result<std::string> read_whole_file(const std::string& path, std::size_t size_max) {
  const auto cannot_read = [&path](const std::string& why) {
    return fail_to_reach("cannot read " + printable(path) + ": " + why);
  };
  // Opening a pipe without a writer would wait for one.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return cannot_read(std::generic_category().message(errno));
  std::string text;
  std::array<char, 65536> block{};
  ssize_t count = 0;
  while (text.size() <= size_max &&
         ((count = read_some(file, block)) > 0 || (count < 0 && errno == EINTR))) {
    text.append(block.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  }
  const int error = errno;
  (void)::close(file);
  if (count < 0 && error == ETIMEDOUT) return cannot_read("it gives nothing for 2 s");
  if (count < 0) return cannot_read(std::generic_category().message(error));
  if (text.size() > size_max) {
    return cannot_read("it is longer than " + std::to_string(size_max) + " bytes");
  }
  return text;
}

}  // namespace palp
