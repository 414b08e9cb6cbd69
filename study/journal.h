#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.h"

namespace palp::study {

/// Who may read a file that is made.
enum class Readers : std::uint8_t { Anybody, Owner };

/// A file of lines that only grows, each line on the disk before the next thing happens. One
/// program at a time: a second one is refused, and what the first one wrote is read after that.
/// Blocks; thread: one.
class Journal {
 public:
  /// Made where it is not there, and read. Nothing but a regular file is opened, and no link is
  /// followed. The error is a CannotOpen.
  [[nodiscard]] static Result<Journal> open(const std::string& path,
                                            Readers readers = Readers::Anybody);
  Journal(Journal&& other) noexcept;
  Journal& operator=(Journal&&) = delete;
  ~Journal();

  /// What was there when it was opened.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// Cuts off what lies behind `whole` [bytes] of text(), a line that was never finished. What is
  /// cut off is kept beside the file, at the end of NAME.cut.
  [[nodiscard]] Result<void> cut(std::size_t whole);
  /// `line` has its end. Once this returns without an error it survives the program and the power.
  [[nodiscard]] Result<void> add(std::string_view line);

 private:
  Journal(int descriptor, std::string path) : descriptor_{descriptor}, path_{std::move(path)} {}
  [[nodiscard]] Result<void> read();

  int descriptor_;
  std::string path_;
  std::string text_{};
};

}  // namespace palp::study
