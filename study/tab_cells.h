#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace palp::study {

/// The cells of a line of a table, between its tabs; at least one.
[[nodiscard]] inline std::vector<std::string_view> tab_cells(std::string_view line) {
  std::vector<std::string_view> out;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find('\t', begin);
    out.push_back(line.substr(begin, end - begin));
    if (end == std::string_view::npos) return out;
    begin = end + 1;
  }
}

}  // namespace palp::study
