#pragma once

#include <string_view>

#include "tests/house/source.h"

/// Who may include whom, and which library is seen where. An arrow moves by editing the tables in
/// arrows.cc in the same commit.
namespace palp::house {

/// The room of a file, e.g. "common/link"; empty: none of the table.
[[nodiscard]] std::string_view room_of(std::string_view path);

/// Quoted includes: the rooms they may name.
[[nodiscard]] Violations forbidden_arrows(const Source& source);

/// Includes of other people's headers, and of generated ones.
[[nodiscard]] Violations broken_fences(const Source& source);

/// `pattern` as in a shell; '*' does not cross '/'.
[[nodiscard]] bool matches(std::string_view path, std::string_view pattern);

}  // namespace palp::house
