#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "common/record/file_bytes.h"

namespace palp::review {

/// Several lines for people: duration, topics with counts and rates, drops, closed or not.
[[nodiscard]] std::string describe(const record::FileBytes& file);

}  // namespace palp::review
