#pragma once

#include <algorithm>
#include <cmath>

#include "fem/mesh.h"

namespace palp::fem {

inline constexpr double kAnySize = 1e9;  // [m], leaves a size to the other conditions

/// Element sizes and counts of one accuracy. Lengths are in indenter radii: the contact scales with
/// it. The contact radius at d is near sqrt(R d), so sizes grow with r and every d sees about the
/// same number of elements under the contact.
struct Sizes {
  double scale{1};               ///< [-], Normal: 1
  double contact{0.024};         ///< [-], at the axis
  double contact_growth{0.045};  ///< [-], per radius
  double surface_row{0.045};     ///< [-], thickness of the first row below the contact
  int rows{12};                  ///< of the fan
  int inner_rows{4};             ///< of the inclusion
  int side{8};                   ///< elements along the inclusion's side
  int below{4};                  ///< along its lower part
  int rim{4};                    ///< columns between the contact and the box

  explicit Sizes(Accuracy accuracy) {
    const double fine = accuracy == Accuracy::Fine ? 2 : accuracy == Accuracy::Coarse ? 0.6 : 1;
    scale = 1 / fine;
    contact *= scale;
    contact_growth *= scale;
    surface_row *= scale;
    const auto more = [&](int count) {
      return std::max(2, static_cast<int>(std::lround(count * std::min(fine, 1.6))));
    };
    rows = more(rows);
    inner_rows = more(inner_rows);
    side = more(side);
    below = more(below);
    rim = more(rim);
    side += side % 2;  // as many above the inclusion's middle as below
  }
  [[nodiscard]] int count(double wanted) const {
    return std::max(2, static_cast<int>(std::lround(wanted / scale)));
  }
};

}  // namespace palp::fem
