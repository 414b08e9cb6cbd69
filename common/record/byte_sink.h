#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.h"

/// Where the bytes of a recording go. Thread: the record thread's.
namespace palp::record {

/// Takes bytes in order. Owned by whoever closes the recording; outlives its writer.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  /// @returns false: not all of it was taken (disk full); the recording then ends here.
  virtual bool write(std::span<const std::byte> bytes) noexcept = 0;
  /// There is a disk: what is long may be put down there.
  [[nodiscard]] virtual bool on_disk() const noexcept { return false; }
};

/// A file of its own: creating it over an existing one is refused, a recording is never destroyed.
class FileSink final : public ByteSink {
 public:
  [[nodiscard]] static Result<FileSink> create(const std::string& path);
  FileSink(FileSink&& other) noexcept;
  FileSink& operator=(FileSink&& other) noexcept;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;
  ~FileSink() override;
  bool write(std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] bool on_disk() const noexcept override { return true; }

 private:
  explicit FileSink(int descriptor) noexcept : descriptor_{descriptor} {}
  int descriptor_{-1};
};

/// Keeps everything, for tests and small files.
class MemorySink final : public ByteSink {
 public:
  bool write(std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Counts and forgets: virtual time makes every byte of a session without keeping it.
class NullSink final : public ByteSink {
 public:
  bool write(std::span<const std::byte> bytes) noexcept override {
    size_ += bytes.size();
    return true;
  }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }  ///< [bytes]

 private:
  std::uint64_t size_{};
};

}  // namespace palp::record
