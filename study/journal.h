#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace palp::study {

/// A file of lines that only grows, each line on the disk before the next thing happens. One
/// program at a time: a second one is refused. Blocks; thread: one.
class Journal {
 public:
  /// Made where it is not there; what lies behind `whole` bytes, a line that was never finished, is
  /// cut off. The error is a CannotOpen.
  [[nodiscard]] static Result<Journal> open(const std::string& path, std::size_t whole);
  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&&) = delete;
  ~Journal();

  /// `line` has its end. Once this returns without an error it survives the program and the power.
  [[nodiscard]] Result<void> add(std::string_view line);

 private:
  Journal(int descriptor, std::string path) : descriptor_{descriptor}, path_{std::move(path)} {}

  int descriptor_;
  std::string path_;
};

}  // namespace palp::study
