#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace palp::review {

/// `value` with `digits` behind the point.
[[nodiscard]] inline std::string fixed(double value, int digits) {
  std::array<char, 400> buffer{};  // the longest double has 309 digits before the point
  const int size = std::snprintf(buffer.data(), buffer.size(), "%.*f", digits, value);
  return {buffer.data(), static_cast<std::size_t>(size)};
}

/// Filled with blanks on the left up to `width`.
[[nodiscard]] inline std::string right(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}
/// Filled with blanks on the right.
[[nodiscard]] inline std::string left(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

}  // namespace palp::review
