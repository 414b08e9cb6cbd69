#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "common/core/result.h"
#include "common/record/file_bytes.h"
#include "surgeon_site/gesture_script.h"

namespace palp::surgeon {

/// What the hand of a recorded session wanted, to be wanted again: of a surgeon's session file
/// (`file`, its bytes) the motion from the first engaged tick to the last, and on top of it what
/// the force bent a grip of `hand_stiffness` [N/m] then, so that another force bends it again. It
/// is the mean of each 20 ms, a point every 10 ms, the recorded tremor in it; while the session was
/// broken off, a straight line. Each time in the tissue is a tap or a press, with a phase of its
/// own. A sentence where the file is no such recording. Not for rt.
[[nodiscard]] Result<GestureScript> parse_recording(const record::FileBytes& file,
                                                    double hand_stiffness);
/// The same of a file's path.
[[nodiscard]] Result<GestureScript> load_recording(const std::string& path, double hand_stiffness);

}  // namespace palp::surgeon
