#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <termios.h>

#include "common/core/time.h"
#include "common/io/process/descriptor.h"

namespace palp::io {

enum class StopCause : std::uint8_t { Key, Signal };

/// The person at the terminal: r asks for a reset, m marks a moment, t asks for a tare; any other
/// key, ^C, SIGTERM or the terminal's own end asks the program to stop; a second signal ends it
/// hard. That nobody reads its output any more does not end it. Make it first in main, before any
/// thread: threads inherit that the signals wait. Keys are read one by one and without echo while
/// standard input is a terminal and the program in its foreground. One to a process. Thread: main.
class Terminal {
 public:
  Terminal();
  /// Puts the terminal back. A program that was asked to stop is ended by the next signal; one that
  /// ends by itself by the second, the first is too late to ask anything.
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Waits up to `span` for a key or a signal. Once there was one it answers at once, and a
  /// further signal ends the program.
  [[nodiscard]] std::optional<StopCause> wait_for_stop(Duration span);
  /// How often r was pressed.
  [[nodiscard]] std::uint32_t resets() const noexcept { return resets_; }
  /// How often m was pressed.
  [[nodiscard]] std::uint32_t marks() const noexcept { return marks_; }
  /// How often t was pressed.
  [[nodiscard]] std::uint32_t tares() const noexcept { return tares_; }
  /// Whether standard output is one (and a line may be written over).
  [[nodiscard]] static bool output_is_terminal() noexcept;
  /// How wide it is now; 0: unknown, or standard output is none.
  [[nodiscard]] static std::size_t output_columns() noexcept;
  [[nodiscard]] bool reads_keys() const noexcept { return keys_; }

 private:
  void read_keys_raw();
  void restore() noexcept;

  Descriptor signals_;
  termios before_{};
  bool keys_{};
  bool restored_{};
  std::uint32_t resets_{};
  std::uint32_t marks_{};
  std::uint32_t tares_{};
  std::optional<StopCause> cause_;
};

}  // namespace palp::io
