#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
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

/// A file of its own, which only its owner may read: creating it over an existing one is refused, a
/// recording is never destroyed.
class FileSink final : public ByteSink {
 public:
  [[nodiscard]] static Result<FileSink> create(const std::string& path);
  FileSink(FileSink&& other) noexcept;
  FileSink& operator=(FileSink&& other) noexcept;
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;
  ~FileSink() override;
  /// A piece that did not go out whole is cut off again. After a fault nothing is taken, unless the
  /// file was only moved or cut.
  bool write(std::span<const std::byte> bytes) noexcept override;
  [[nodiscard]] bool on_disk() const noexcept override { return true; }

  /// Looks whether the name still leads to this file, and to all of it: who removed, moved or cut
  /// it made a fault.
  void look() noexcept;
  /// Waits until the disk has all of it. What the disk refuses then is a fault too.
  void finish() noexcept;
  /// What went wrong, one sentence; empty: nothing.
  [[nodiscard]] std::string fault() const;
  /// Nobody can open it any more: what was written is lost.
  [[nodiscard]] bool removed() const noexcept { return fault_ == Fault::Removed; }
  /// [bytes] that its disk still takes; nothing where the system does not say.
  [[nodiscard]] std::optional<std::uint64_t> room() const noexcept;

 private:
  enum class Fault { None, Refused, Removed, Moved, Truncated };
  FileSink(int descriptor, std::string path) noexcept
      : descriptor_{descriptor}, path_{std::move(path)} {}
  void refuse(int error) noexcept;

  int descriptor_{-1};
  std::string path_;
  std::uint64_t size_{};  ///< [bytes], of whole pieces
  Fault fault_{Fault::None};
  int error_{};  ///< errno of a refusal
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
