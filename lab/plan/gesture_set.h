#pragma once

#include <array>
#include <string_view>

#include "lab/plan/plan.h"

/// The set `gestures`: what a person may do with a hand, by round trip and grip.
namespace palp::lab {

/// One gesture, and the figure by which it is judged. Several may be of one script.
struct Gesture {
  std::string_view name;
  std::string_view script;  ///< that performs it, as surgeon_site/script_reader.h has it; empty:
                            ///< the standard palpation
  std::string_view metric;  ///< of judge::metric_table()
};

inline constexpr std::string_view kFirstPress = "hold 1\npress 4 0.6 6\nlift 0.6 1\n";
inline constexpr std::string_view kSlowPress = "hold 1\npress 4 5 4\nlift 0.6 1\n";
inline constexpr std::string_view kQuickTaps =
    "hold 1\nmove -3 0.5\ntaps 1 4 1 2.5\ntaps 8 4 0.2 0\nlift 0.6 1\n";
/// 20 mm/s at most: a half cosine peaks at pi/2 times its mean.
inline constexpr std::string_view kDragOver =
    "hold 1\nmove -3 0.5\ntaps 2 4 1 1\npress 3 1 2\ndrag to 40,0 in 3.2 s\nhold 2\nlift 1 1\n";

inline constexpr std::array kGestures{
    Gesture{"first tap of a place", "", "tap1_a_error"},
    Gesture{"second tap", "", "tap2_a_error"},
    Gesture{"taps 2 to 4", "", "tap_a_error"},
    Gesture{"press held, after taps", "", "held_a_error"},
    Gesture{"first press of a place, held", kFirstPress, "share_2s"},
    Gesture{"the same, as the energy permits", kFirstPress, "share_permitted"},
    Gesture{"first press, 4 mm in 5 s", kSlowPress, "held_a_error"},
    Gesture{"taps of 5 Hz, place known", kQuickTaps, "tap_a_error"},
    Gesture{"drag over an inclusion: bump, of a finger's", kDragOver, "drag_direct_error"},
    Gesture{"the same, of the tip's", kDragOver, "drag_bump_error"},
    Gesture{"the same, later than at the tip", kDragOver, "drag_shift_s"}};

/// Each script of kGestures, in that order, at five round trips by four grips; label `gesture`: its
/// first gesture.
void fill_gestures(Plan& plan, const PlanAsk& ask);

}  // namespace palp::lab
