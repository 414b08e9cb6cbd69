#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "netem/syntax/timeline.h"

namespace palp::netem {

/// The names of the links there are, in the order of rising delay. Each is a timeline with the
/// sources of its numbers: profiles/NAME.textproto, built into the program.
[[nodiscard]] std::vector<std::string> preset_names();

/// @returns or a sentence that lists the names there are.
[[nodiscard]] Result<Timeline> find_preset(std::string_view name);

/// The words of a preset's file, for people. Empty: there is none of that name.
[[nodiscard]] std::string_view preset_text(std::string_view name);

}  // namespace palp::netem
