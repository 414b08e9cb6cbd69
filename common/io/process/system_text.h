#pragma once

#include <string>

namespace palp::io {

/// What the system says of an errno value, fit for the end of a sentence: `address already in use`.
[[nodiscard]] std::string system_text(int error);

}  // namespace palp::io
