#pragma once

#include <string>
#include <string_view>

#include "common/core/result.h"
#include "surgeon_site/gesture_script.h"
#include "surgeon_site/script_builder.h"

/// Scripts from text. Not for rt: allocates.
namespace palp::surgeon {

/// One phase per line, `#` starts a comment, lengths in millimetres, times in seconds:
///   hold SECONDS
///   air AMPLITUDE_MM FREQUENCY_HZ SECONDS    a whole number of cycles
///   move POSITION_MM SECONDS
///   taps COUNT DEPTH_MM SECONDS PAUSE_SECONDS
///   press DEPTH_MM MOVE_SECONDS HOLD_SECONDS
///   lift MOVE_SECONDS HOLD_SECONDS           to -10 mm
///   site PLACE                               there at once, only while clear of the tissue
///   move to PLACE                            the same, at the speed of a hand
///   tap COUNT times at PLACE                 there, and taps as in the standard palpation
///   drag to PLACE in SECONDS s               only while pressed
///   search COUNT taps from PLACE             where the map proposes, until it says enough
/// PLACE is A, B, X_MM,Y_MM or X_MM.
/// The script begins at -10 mm on site A. Depths and sites as in ScriptBuilder.
[[nodiscard]] Result<GestureScript> parse_script(std::string_view text, double hand_stiffness);

/// A recorded hand: header `t_s,position_mm`, `t_s,position_mm,x_mm,y_mm`, or as it was before
/// there was a plane `t_s,position_mm,lateral_mm`; times strictly rising, positions relative to the
/// surface. The first row is script time 0.
[[nodiscard]] Result<GestureScript> parse_replay(std::string_view text);

}  // namespace palp::surgeon
