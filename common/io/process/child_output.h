#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"

namespace palp::io {

/// What a program of this machine, found by PATH, makes of `input`: its standard output. Blocks
/// until it has ended; not for a control thread. Fails with its last line on standard error where
/// it ends badly, and as not reached where it cannot be started.
[[nodiscard]] Result<std::string> child_output(const std::vector<std::string>& command,
                                               std::string_view input);

}  // namespace palp::io
