#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "netem/impairment.h"

namespace palp::netem {

/// A named link. The numbers and their sources are data: profiles/NAME.txt, built into the program.
struct Preset {
  std::string name;
  std::string summary;  ///< one line
  std::string source;   ///< where the numbers come from; says "assumed" where they do not
  Impairment up;
  Impairment down;
};

/// All of them, in the order of rising delay.
[[nodiscard]] const std::vector<Preset>& presets();

/// @returns or a sentence that lists the names there are.
[[nodiscard]] Result<Preset> find_preset(std::string_view name);

/// Reads one profile: lines `summary: TEXT`, `source: TEXT` (joined when repeated), `up: SPEC`,
/// `down: SPEC` or `both: SPEC`; `#` begins a comment line. @returns or a sentence with the line.
[[nodiscard]] Result<Preset> parse_preset(std::string_view name, std::string_view text);

}  // namespace palp::netem
