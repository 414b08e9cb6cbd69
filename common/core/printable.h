#pragma once

#include <string>
#include <string_view>

namespace palp {

/// Foreign text made fit for a sentence: one line, printable ASCII ('?' for the rest), cut off
/// with "..." after 80 characters.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace palp
