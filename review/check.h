#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "common/record/file_bytes.h"

namespace palp::review {

/// The first fault of a session file in one sentence; nullopt: it is whole, closed, and every
/// message decodes.
[[nodiscard]] std::optional<std::string> first_fault(const record::FileBytes& file);

}  // namespace palp::review
