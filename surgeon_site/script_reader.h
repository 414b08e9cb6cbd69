#pragma once

#include <string>
#include <string_view>

#include "common/core/result.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/script_builder.h"

/// Scripts from text. Not for rt: allocates; load_script reads files.
namespace palp::surgeon {

/// One phase per line, `#` starts a comment, lengths in millimetres, times in seconds:
///   hold SECONDS
///   air AMPLITUDE_MM FREQUENCY_HZ SECONDS    a whole number of cycles
///   move POSITION_MM SECONDS
///   taps COUNT DEPTH_MM SECONDS PAUSE_SECONDS
///   press DEPTH_MM MOVE_SECONDS HOLD_SECONDS
///   lift MOVE_SECONDS HOLD_SECONDS           to -10 mm
///   site A|B|LATERAL_MM                      only while clear of the tissue
/// The script begins at -10 mm on site A. Depths and sites as in ScriptBuilder.
[[nodiscard]] Result<GestureScript> parse_script(std::string_view text, double hand_stiffness);

/// A recorded hand: header `t_s,position_mm` or `t_s,position_mm,lateral_mm`, times strictly
/// rising, positions relative to the surface. The first row is script time 0.
[[nodiscard]] Result<GestureScript> parse_replay(std::string_view text);

/// `script:standard`, `script:demo`, `script:FILE` or `replay:FILE`; a sentence if there is none.
[[nodiscard]] Result<GestureScript> load_script(const std::string& source,
                                                const ScriptSetting& setting);

}  // namespace palp::surgeon
