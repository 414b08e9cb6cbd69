#pragma once

#include <string_view>

namespace palp {

/// A text file without the mark that some editors and spreadsheets write before its first letter:
/// it would be part of the first name or number.
[[nodiscard]] constexpr std::string_view without_byte_order_mark(std::string_view text) noexcept {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace palp
