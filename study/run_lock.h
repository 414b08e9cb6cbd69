#pragma once

#include <string>

#include "common/core/result.h"

namespace palp::study {

/// Who runs a study: one program alone while it says who answers, then all those beside each other
/// for whom that is so. Held until it is gone, whatever ends the program. Thread: one.
class RunLock {
 public:
  /// The file is made where it is not there; no link is followed. The error is a CannotOpen.
  [[nodiscard]] static Result<RunLock> open(const std::string& path);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&&) = delete;
  ~RunLock();

  /// Nobody else holds it; does not wait.
  [[nodiscard]] bool alone();
  /// Beside others; waits while one is alone. Between alone() and this somebody else may have been.
  [[nodiscard]] Result<void> beside_others();

 private:
  RunLock(int descriptor, std::string path) : descriptor_{descriptor}, path_{std::move(path)} {}

  int descriptor_;
  std::string path_;
};

}  // namespace palp::study
