#pragma once

#include <cstddef>
#include <string>

#include "common/core/result.h"

namespace palp {

inline constexpr std::size_t kWholeFileMax = std::size_t{1}
                                             << 20;  ///< [bytes], people write a few thousand

/// The content of a file that somebody named. A pipe or device that gives nothing for 2 s is
/// refused, so that no name makes a program hang.
/// @param size_max [bytes] more is refused.
/// @returns the bytes, or one sentence with the name; the error is always `unreachable`.
/// Thread: any that may wait.
[[nodiscard]] Result<std::string> read_whole_file(const std::string& path,
                                                  std::size_t size_max = kWholeFileMax);

}  // namespace palp
