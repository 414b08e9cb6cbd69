#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/process/message_pipe.h"

namespace palp::io {

/// A program that runs beside this one and ends with it, however that ends. Thread: its maker's,
/// whose end it would not survive either.
class ChildProgram {
 public:
  /// Where the child finds its end of a pipe.
  static constexpr int kPipeNumber = 3;

  /// `command`: found by PATH where it names no folder. `log`: a file that gets what it says, made
  /// anew. `pipe`: the child's end, or null. The error is a CannotOpen.
  [[nodiscard]] static Result<ChildProgram> start(const std::vector<std::string>& command,
                                                  const std::string& log,
                                                  const MessagePipe* pipe = nullptr);
  ChildProgram(ChildProgram&& other) noexcept;
  ChildProgram& operator=(ChildProgram&& other) noexcept;
  ~ChildProgram();  ///< as stop() with no patience

  [[nodiscard]] bool running() noexcept;
  /// Its exit code, or 128 and the signal that ended it; of one that has ended.
  [[nodiscard]] std::optional<int> end_code() const noexcept { return end_code_; }
  /// Waits so long at most for it to end by itself. @returns whether it has.
  bool ends_within(Duration span) noexcept;
  /// Asks it to end (SIGTERM), waits so long at most, and ends it.
  void stop(Duration patience) noexcept;

 private:
  explicit ChildProgram(pid_t process) noexcept : process_{process} {}
  void note_end(int status) noexcept;

  pid_t process_{};  ///< 0: moved from
  std::optional<int> end_code_;
};

}  // namespace palp::io
