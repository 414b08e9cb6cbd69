#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "patient_site/force_table.h"

namespace palp::patient {

/// A tissue held at one depth lets go of a share of its force: F(t) is the elastic force less
/// `share` of what that was, on exponential average, over `time` (Fung 1993, quasi-linear
/// viscoelasticity with one time).
struct Relaxation {
  double share{};  ///< [-]; 0: none
  double time{1};  ///< [s]
};

/// The history of one place where such a tissue is pressed. A value.
class RelaxingForce {
 public:
  explicit RelaxingForce(const Relaxation& relaxation) noexcept : relaxation_{relaxation} {}
  /// The force [N] where the elastic one is `elastic` [N]; `span` [s] since the last call.
  double step(double elastic, double span) noexcept {
    if (relaxation_.share <= 0) return elastic;
    past_ += span / relaxation_.time * (elastic - past_);
    const double force = elastic - relaxation_.share * past_;
    return elastic > 0 && force > 0 ? force : 0;
  }

 private:
  Relaxation relaxation_;
  double past_{};  ///< [N]
};

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
  Relaxation relaxation{};       ///< of the whole tissue

  /// The tissue at a place: the sites are `kSiteBoundary` apart.
  [[nodiscard]] const ForceTable& at(double lateral) const noexcept {
    return lateral < kSiteBoundary ? plain : over;
  }
  [[nodiscard]] double depth_max() const noexcept;  ///< [m], where both tables still hold

  static constexpr double kSiteBoundary = 5e-3;  ///< [m], of lateral: below it site A
};

/// `paper-5mm|paper-10mm|paper-15mm|paper-20mm|paper-25mm|none`, `closed-form[:DEPTH_MM]`,
/// `exponential[:DEPTH_MM]`, `relaxing[:DEPTH_MM]` (smooth analytic laws for checks, not tissues),
/// `file:PATH.csv`, or from the depth database `ball depth=12 radius=8 ratio=200` (also
/// `cylinder`). Everything else gives a sentence.
[[nodiscard]] Result<Phantom> make_phantom(std::string_view spec);

/// Both tables as CSV text, columns `site,d_mm,F_N`: what a session file keeps of its tissue.
[[nodiscard]] std::string tissue_csv(const Phantom& phantom);

}  // namespace palp::patient
