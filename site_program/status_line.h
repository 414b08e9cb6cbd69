#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "common/core/time.h"

namespace palp::site_program {

/// The live line of a program on standard output: written over itself on a terminal, otherwise a
/// plain line every two seconds. Thread: main.
class StatusLine {
 public:
  StatusLine();
  /// Ends the line.
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(std::string_view text, TimePoint now);
  /// How many columns are left behind `before`; 0: no end, nothing is written over. At least 1.
  [[nodiscard]] std::size_t room_behind(std::string_view before) const;
  /// A sentence on standard error, as io::info() and io::warn(), that does not break the line.
  void info(std::string_view sentence);
  void warn(std::string_view sentence);
  /// Leaves the text where it is, because something else will be printed.
  void end();

 private:
  bool over_itself_;
  bool open_{};
  std::optional<TimePoint> printed_at_;
};

}  // namespace palp::site_program
