#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The tree as text: what the rules of this folder read.
namespace palp::house {

/// One file. `code` and `comments` are as long as `lines`: the same columns, with everything else
/// blanked out; in `code` the insides of literals are blank too.
struct Source {
  std::string path;  ///< from the root of the tree, with '/'
  std::size_t size{};
  std::vector<std::string> lines;
  std::vector<std::string> code;
  std::vector<std::string> comments;

  [[nodiscard]] bool ends_with(std::string_view end) const { return path.ends_with(end); }
  [[nodiscard]] bool is_header() const { return ends_with(".h"); }
  [[nodiscard]] bool is_code() const { return is_header() || ends_with(".cc"); }
  [[nodiscard]] bool is_under(std::string_view folder) const;
};

/// `quoted`: "a/b.h", else <a/b.h>.
struct Include {
  std::string target;
  std::size_t line{};  ///< from 1
  bool quoted{};
};

/// A rule that is broken, where, and why that matters.
struct Violation {
  std::string path;
  std::size_t line{};  ///< from 1; 0: the whole file
  std::string sentence;
};
using Violations = std::vector<Violation>;

[[nodiscard]] Source make_source(std::string path, std::string_view text);
[[nodiscard]] std::vector<Include> includes(const Source& source);

/// All files below `root` but those of builds, runs and version control. Text files are split into
/// lines, of others only the size is kept.
[[nodiscard]] std::vector<Source> read_tree(const std::filesystem::path& root);

/// "path:line: sentence", one a line.
[[nodiscard]] std::string listing(const Violations& violations);

}  // namespace palp::house
