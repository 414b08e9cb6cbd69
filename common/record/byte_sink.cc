#include "common/record/byte_sink.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace palp::record {

Result<FileSink> FileSink::create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    return fail("session file " + path + " cannot be created: " + std::strerror(errno));
  }
  return FileSink{descriptor};
}

FileSink::FileSink(FileSink&& other) noexcept : descriptor_{std::exchange(other.descriptor_, -1)} {}

FileSink& FileSink::operator=(FileSink&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileSink::~FileSink() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

bool FileSink::write(std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t taken = ::write(descriptor_, bytes.data(), bytes.size());
    if (taken < 0 && errno == EINTR) {
      continue;
    }
    if (taken <= 0) {
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(taken));
  }
  return true;
}

bool MemorySink::write(std::span<const std::byte> bytes) noexcept {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return true;
}

}  // namespace palp::record
