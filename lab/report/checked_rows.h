#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"

/// Rows that say whether they are whole: the last cell of each is a check over all before it; and
/// whether all are there.
namespace palp::lab {

/// Name of that column.
inline constexpr std::string_view kCheckName = "check";

/// `row` has no line end.
[[nodiscard]] std::string with_check(const std::string& row);
/// Whether a row, without its line end, is as with_check() made it.
[[nodiscard]] bool holds_check(std::string_view row);

/// The header of `text`, and of its other lines those that are whole and hold their check.
[[nodiscard]] std::string sound_rows(std::string_view text);

/// `indices`, sorted, of the rows of all shards: nothing where they are 0 to `count` - 1, each
/// once.
[[nodiscard]] Result<void> check_all_there(const std::vector<std::uint64_t>& indices,
                                           std::uint64_t count);

}  // namespace palp::lab
