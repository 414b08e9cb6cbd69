#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/config/exit_status.h"
#include "common/core/result.h"

/// Writing what scripts read.
namespace palp::config {

/// The file is there whole or not at all: written to a temporary name in the same folder, synced,
/// renamed. What it takes the place of keeps its rights, and stays if nobody may write to it. A
/// device or a pipe (/dev/stdout) is written to directly. Blocks; not for a control thread. The
/// error is a CannotOpen.
[[nodiscard]] Result<void> write_whole_file(const std::string& path, std::string_view text);

/// Whether write_whole_file() could write there now: tries, and leaves nothing behind. For runs
/// that take long. The error is a CannotOpen.
[[nodiscard]] Result<void> can_write_file(const std::string& path);
/// The same of several; nobody asked for those whose path is empty.
[[nodiscard]] Result<void> can_write_files(const std::vector<std::string>& paths);

/// Of a run that came to nothing, as JSON: schema, outcome ("bad input" or "cannot start"), reason.
[[nodiscard]] std::string failure_report(const std::string& schema, const ExitStatus& exit_status);

/// A JSON number that reads back as the same double, or "null" where it is not finite.
[[nodiscard]] std::string json_number(double value);

}  // namespace palp::config
