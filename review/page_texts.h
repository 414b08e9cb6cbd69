#pragma once

#include <string_view>

namespace palp::review {

/// A file of review/page, which the program holds inside: report, uplot-code, uplot-style,
/// uplot-license, or plane: the map of the live page. Empty: there is none of that name.
[[nodiscard]] std::string_view page_text(std::string_view name) noexcept;

}  // namespace palp::review
