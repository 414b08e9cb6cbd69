#pragma once

#include <optional>
#include <string>
#include <vector>

namespace palp::config {

/// Whether both names lead to one regular file, or would once it is made.
[[nodiscard]] bool same_file(const std::string& one, const std::string& other);

/// A file that a flag of a command has the program write.
struct Output {
  std::string flag;
  std::string file;
};

/// An output that would take the place of a session file, which nobody can record again, or of
/// another file of the same command, whether read or written: the sentence that says so. `words`:
/// of the command line, program and flags included; `verb` is no file; `settings`: their text, in
/// which values stand in quotes.
[[nodiscard]] std::optional<std::string> output_clash(const Output& output,
                                                      const std::vector<std::string>& words,
                                                      const std::string& verb,
                                                      const std::string& settings);

}  // namespace palp::config
