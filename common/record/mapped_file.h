#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "common/core/result.h"
#include "common/record/file_bytes.h"

namespace palp::record {

/// The bytes of a file, read-only and paged in as they are looked at: a session of hours needs no
/// memory of its own. The file must not be shortened meanwhile.
class MappedFile {
 public:
  [[nodiscard]] static Result<MappedFile> open(const std::string& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] FileBytes bytes() const noexcept { return FileBytes::of_mapping(bytes_); }

 private:
  explicit MappedFile(std::span<std::byte> bytes) noexcept : bytes_{bytes} {}
  std::span<std::byte> bytes_;
};

}  // namespace palp::record
