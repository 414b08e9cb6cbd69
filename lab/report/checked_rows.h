#pragma once

#include <string>
#include <string_view>

/// Rows that say whether they are whole: the last cell of each is a check over all before it.
namespace palp::lab {

/// Name of that column.
inline constexpr std::string_view kCheckName = "check";

/// `row` has no line end.
[[nodiscard]] std::string with_check(const std::string& row);
/// Whether a row, without its line end, is as with_check() made it.
[[nodiscard]] bool holds_check(std::string_view row);

/// The header of `text`, and of its other lines those that are whole and hold their check.
[[nodiscard]] std::string sound_rows(std::string_view text);

}  // namespace palp::lab
