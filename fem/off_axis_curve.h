#pragma once

#include <vector>

#include "common/core/result.h"
#include "fem/curve.h"

namespace palp::fem {

/// How the tip comes to the surface above the ball.
struct Approach {
  double offset{};  ///< [m], of the tip's first touch from the ball's axis
  double tilt{};    ///< [rad], of its way off the normal; > 0: it walks to larger offsets
  double surface_curvature{};  ///< [1/m], > 0: a dome, < 0: a hollow
  [[nodiscard]] bool straight() const noexcept {
    return offset == 0 && tilt == 0 && surface_curvature == 0;
  }
};

/// Force along the tip's way with the tip beside the ball's axis. A frictionless surface knows the
/// way's part along the normal alone, while the contact walks:
///   F(d) = cos t F_n(d cos t; offset + d sin t),
///   F_n(d; x) = F_plain(d) dome(d) exp(e(d) g(d; x)),  g = e_L1(d; x) / e_L1(d; 0),
/// F_plain and e = ln F / F_plain of the asked model on the axis, the shape g of the ball's effect
/// by OffAxisContact, dome(d) the plain block's in L1 as well. So x = 0 is what solve_curve()
/// finds. The ball's axis is the block's; its side counts as being as far from the tip as on the
/// axis. Ball or no inclusion. contact_radius goes between those with and without the ball as ln F
/// does; error is the mesh's on the axis. Rows in the order asked; or one sentence with what cannot
/// be. Thread: any.
[[nodiscard]] Result<std::vector<CurveRow>> solve_off_axis_curve(const CurveRequest& request,
                                                                 const Approach& approach);

}  // namespace palp::fem
