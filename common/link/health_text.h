#pragma once

#include <string>

#include "common/link/telegram.h"

namespace palp::link {

/// A link on a site's status line: "rtt 75.1 ms (there 37.9, here 37.2)  loss 0.1 %", and for how
/// long nothing has come where it should have.
[[nodiscard]] std::string health_text(const LinkHealth& health);
/// The same in few characters: the round trip, or the silence.
[[nodiscard]] std::string health_brief(const LinkHealth& health);

}  // namespace palp::link
