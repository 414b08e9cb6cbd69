#include "common/record/byte_sink.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace palp::record {

Result<FileSink> FileSink::create(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) {
    return fail("session file " + path + " cannot be created: " + std::strerror(errno));
  }
  return FileSink{descriptor, path};
}

FileSink::FileSink(FileSink&& other) noexcept
    : descriptor_{std::exchange(other.descriptor_, -1)},
      path_{std::move(other.path_)},
      size_{other.size_},
      fault_{other.fault_},
      error_{other.error_} {}

FileSink& FileSink::operator=(FileSink&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  std::swap(size_, other.size_);
  std::swap(fault_, other.fault_);
  std::swap(error_, other.error_);
  return *this;
}

FileSink::~FileSink() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

bool FileSink::write(std::span<const std::byte> bytes) noexcept {
  if (fault_ == Fault::Refused || fault_ == Fault::Removed) return false;
  const std::size_t whole = bytes.size();
  while (!bytes.empty()) {
    const ssize_t taken = ::write(descriptor_, bytes.data(), bytes.size());
    if (taken < 0 && errno == EINTR) {
      continue;
    }
    if (taken <= 0) {
      refuse(taken < 0 ? errno : ENOSPC);
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(taken));
  }
  size_ += whole;
  return true;
}

void FileSink::refuse(int error) noexcept {
  fault_ = Fault::Refused;
  error_ = error;
  // A reader finds whole records only, and the disk gets back what no reader could use.
  (void)!::ftruncate(descriptor_, static_cast<off_t>(size_));
}

void FileSink::look() noexcept {
  if (fault_ != Fault::None) return;
  struct stat own {};
  struct stat named {};
  if (::fstat(descriptor_, &own) != 0) return;
  if (own.st_nlink == 0) {
    fault_ = Fault::Removed;
  } else if (::stat(path_.c_str(), &named) != 0 || named.st_dev != own.st_dev ||
             named.st_ino != own.st_ino) {
    fault_ = Fault::Moved;
  } else if (own.st_size >= 0 && static_cast<std::uint64_t>(own.st_size) < size_) {
    fault_ = Fault::Truncated;
  }
}

void FileSink::finish() noexcept {
  look();
  if (fault_ == Fault::None && ::fdatasync(descriptor_) != 0 && errno != EINVAL) {
    fault_ = Fault::Refused;
    error_ = errno;
  }
}

std::string FileSink::fault() const {
  switch (fault_) {
    case Fault::None:
      break;
    case Fault::Refused:
      return "session file " + path_ +
             " could not be written any further: " + std::strerror(error_);
    case Fault::Removed:
      return "session file " + path_ + " was removed while it was written";
    case Fault::Truncated:
      return "session file " + path_ + " was cut short while it was written";
    case Fault::Moved:
      return "session file " + path_ + " was moved or replaced while it was written";
  }
  return {};
}

std::optional<std::uint64_t> FileSink::room() const noexcept {
  struct statvfs disk {};
  if (::fstatvfs(descriptor_, &disk) != 0) return std::nullopt;
  return std::uint64_t{disk.f_bavail} * disk.f_frsize;
}

bool MemorySink::write(std::span<const std::byte> bytes) noexcept {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return true;
}

}  // namespace palp::record
