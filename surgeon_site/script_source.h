#pragma once

#include <string>

#include "common/core/result.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/script_builder.h"

namespace palp::surgeon {

/// `script:standard`, `script:demo`, `script:map`, `script:search`, `script:breath`, `script:long`,
/// `script:random:SEED` (see drawn_script), `script:FILE`, `replay:FILE` or `recording:FILE`; a
/// sentence if there is none. Not for rt: reads files.
[[nodiscard]] Result<GestureScript> load_script(const std::string& source,
                                                const ScriptSetting& setting);

/// Whether a source is made by the program itself, and so the same everywhere.
[[nodiscard]] bool is_ready_made(const std::string& source);

}  // namespace palp::surgeon
