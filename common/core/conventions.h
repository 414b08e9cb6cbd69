#pragma once

/// Conventions of the whole house; every header cites this page instead of repeating it.
///
/// Axis      One axis x [m], + into the tissue, 0 at the nominal undeformed surface.
///           x_m: hand (master), x_s: tip (stage). Indentation d = x - surface, surface as found.
/// Forces    Contact force F_c >= 0 [N] in compression, F_s its measured value.
///           Hand force F_h [N]: positive pushes the hand out of the tissue; the force on the hand
///           along +x is -F_h. In these signs eq. (1) of the paper reads
///           F_h = alpha * F_s + k_p * (beta * x_m - x_s).
/// Place     x and y [m] on the undeformed surface (place.h); a new place means new tissue.
/// Units     SI and double inside. At a border (proto, config, CSV, flags, log) the unit ends the
///           name: depth_mm, force_n, sent_at_ns; conversion happens once, where the value enters.
/// Time      See time.h: instants and spans are chrono types, `now` is always an argument.
/// Period    The control period is 1 ms; a tick's dt is a whole number of periods.

namespace palp {

inline constexpr double kMillimetre = 1e-3;  ///< [m]

}  // namespace palp
