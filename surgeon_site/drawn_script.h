#pragma once

#include <cstdint>

#include "surgeon_site/script_builder.h"

namespace palp::surgeon {

/// A palpation that nobody chose, drawn from `seed`: 1 s of rest and 3 s in the air, then six
/// gestures on sites A and B in turns that are drawn as well: taps of 1 to 5 Hz with or without
/// pauses, a press that is held for 2 to 6 s (one in six for 20 s), one that creeps in over 3 to
/// 8 s, a press that is tapped on from within the tissue, and a drag of 5 to 30 mm/s from one site
/// to the other. Depths are 1 to 5 mm in plain tissue. The first contact of a place is as often a
/// press as a tap. No law of force is tuned on it.
[[nodiscard]] GestureScript drawn_script(std::uint64_t seed, const ScriptSetting& setting);

}  // namespace palp::surgeon
