#pragma once

#include <optional>
#include <string>

#include "common/core/result.h"

namespace palp::review {

/// Writes `text` to a temporary name beside `path`, then renames it: a report is whole or absent.
[[nodiscard]] std::optional<Error> write_whole(const std::string& path, const std::string& text);

}  // namespace palp::review
