#pragma once

#include <string>

#include "common/message/map_report.h"

/// A map report for people. Thread: any; allocates.
namespace palp {

/// All of it, in whole sentences: what was found and what that assumes, why its numbers are not to
/// be trusted and what helps, and where to touch next. A report with number 0: that touches at too
/// few places were heard.
[[nodiscard]] std::string map_sentence(const MapReport& report);

/// On a status line: "inclusion at 20.1,0.3: top 9.8 mm deep (9.1 to 10.6), radius 14.9 (13 to
/// 16)", a "?" behind it where it is not trusted, and the next tap.
[[nodiscard]] std::string map_line(const MapReport& report);

/// The same in few characters.
[[nodiscard]] std::string map_brief(const MapReport& report);

}  // namespace palp
