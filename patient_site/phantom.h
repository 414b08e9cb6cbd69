#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "patient_site/force_table.h"

namespace palp::patient {

/// A simulated tissue: a plain block with, at another place along its surface, an inclusion below.
/// A value; immutable after make_phantom.
struct Phantom {
  std::string name;
  ForceTable plain;              ///< site A: the block beside the inclusion
  ForceTable over;               ///< site B: above the inclusion
  std::optional<double> depth;   ///< [m], top of the inclusion below the undeformed surface
  std::optional<double> radius;  ///< [m]
  std::optional<double> ratio;   ///< [-], stiffness of the inclusion over that of the block
  std::string shape;             ///< "ball", "cylinder", "none" or "unknown"

  /// The tissue at a place: the sites are `kSiteBoundary` apart.
  [[nodiscard]] const ForceTable& at(double lateral) const noexcept {
    return lateral < kSiteBoundary ? plain : over;
  }
  [[nodiscard]] double depth_max() const noexcept;  ///< [m], where both tables still hold

  static constexpr double kSiteBoundary = 5e-3;  ///< [m], of lateral: below it site A
};

/// `paper-5mm|paper-10mm|paper-15mm|paper-20mm|paper-25mm|none`, `closed-form[:DEPTH_MM]` (a smooth
/// analytic law for checks, not a tissue), `file:PATH.csv`, or from the depth database
/// `ball depth=12 radius=8 ratio=200` (also `cylinder`). Everything else gives a sentence.
[[nodiscard]] Result<Phantom> make_phantom(std::string_view spec);

/// Both tables as CSV text, columns `site,d_mm,F_N`: what a session file keeps of its tissue.
[[nodiscard]] std::string tissue_csv(const Phantom& phantom);

}  // namespace palp::patient
