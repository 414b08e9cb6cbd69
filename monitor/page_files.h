#pragma once

#include <string_view>

namespace palp::monitor {

struct PageFile {
  std::string_view media_type;  ///< empty: there is no such file
  std::string_view text;
};

/// A file of monitor/web/dist, which the program holds inside, by its path: "/" or "/page.js".
[[nodiscard]] PageFile page_file(std::string_view path) noexcept;

}  // namespace palp::monitor
