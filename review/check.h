#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "common/record/file_bytes.h"

namespace palp::review {

struct Checked {
  /// The first fault, in one sentence; nullopt: it is whole, closed, and every message decodes.
  std::optional<std::string> fault;
  std::string lack;  ///< of a file without fault, as lack_of() has it
};
[[nodiscard]] Checked checked(const record::FileBytes& file);

}  // namespace palp::review
