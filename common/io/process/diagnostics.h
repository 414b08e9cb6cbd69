#pragma once

#include <string_view>

/// One sentence with values and units, for people, on standard error. Never from rt: it leaves
/// notes (common/record/notes.h). Thread: any other.
namespace palp::io {

/// Names the program in front of each sentence. Call once, first in main.
void start_diagnostics(std::string_view program);

void info(std::string_view sentence);
void warn(std::string_view sentence);
void error(std::string_view sentence);

}  // namespace palp::io
