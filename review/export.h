#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "common/record/file_bytes.h"

namespace palp::review {

enum class ExportFormat : std::uint8_t {
  Csv,  ///< one topic
  Mat   ///< MAT-file of level 4: a column vector for each field of each topic
};

struct ExportAsk {
  std::vector<std::string> topics{};  ///< "surgeon/tick"; CSV: exactly one
  double from{};                      ///< [s], since the file's first sample
  std::optional<double> to{};         ///< [s], absent: the end
  ExportFormat format{ExportFormat::Csv};
};

struct Exported {
  std::uint64_t messages{};
  std::string lack;  ///< of what was looked at, as lack_of() has it
};

/// Writes the numbers of a session file's messages to `path`, a new file; columns carry units in
/// their names and begin with `t_s`, since the file's first sample, and `stamp_ns` or, in MAT files
/// whose numbers are doubles, `utc_s`. @returns what was written; a sentence where a topic is not
/// in the file, or the file cannot be made.
[[nodiscard]] Result<Exported> export_file(const record::FileBytes& file,
                                           const ExportAsk& ask,
                                           const std::string& path);

}  // namespace palp::review
