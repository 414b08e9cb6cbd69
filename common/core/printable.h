#pragma once

#include <string>
#include <string_view>

namespace palp {

/// Foreign text made fit for a sentence: one line, printable ASCII ('?' for the rest), cut off
/// with "..." after 80 characters.
[[nodiscard]] std::string printable(std::string_view text);

/// Foreign text for a terminal, a log or a picture: UTF-8 stays, what a terminal would obey or what
/// would turn the order of the text about does not. Control characters but tab and line break,
/// C1 ones, marks of direction and bytes that are no UTF-8 become '?'.
[[nodiscard]] std::string harmless(std::string_view text);
/// The same in one line, with '?' for a tab and a line break too.
[[nodiscard]] std::string harmless_line(std::string_view text);

}  // namespace palp
