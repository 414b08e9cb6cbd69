#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patient_site/tissue_field.h"

namespace palp::patient {

/// A tissue held at one depth lets go of shares of its force: F(t) is the elastic force less, for
/// each of some times, a share of what that was on exponential average (Fung 1993, quasi-linear
/// viscoelasticity as a Prony series).
struct Relaxation {
  struct Part {
    double share{};  ///< [-]; 0: none
    double time{1};  ///< [s]
  };
  static constexpr std::size_t kParts = 10;
  std::array<Part, kParts> parts{};  ///< those without a share come last
};

/// What lets go of `share` [-] in all as 1 - exp(-sqrt(t/time)): no one time says it. As the fluid
/// drains out of a tissue after a step (Hu, Zhao, Vlassak and Suo 2010: a spherical tip, short
/// times), to 0.4 % of the force let go of from 10 ms to 60 s.
[[nodiscard]] Relaxation stretched_relaxation(double share, double time) noexcept;

/// The history of one place where such a tissue is pressed. A value.
class RelaxingForce {
 public:
  explicit RelaxingForce(const Relaxation& relaxation) noexcept : relaxation_{relaxation} {}
  /// The force [N] where the elastic one is `elastic` [N]; `span` [s] since the last call.
  double step(double elastic, double span) noexcept {
    double force = elastic;
    for (std::size_t k = 0; k < past_.size() && relaxation_.parts[k].share > 0; ++k) {
      past_[k] += span / relaxation_.parts[k].time * (elastic - past_[k]);
      force -= relaxation_.parts[k].share * past_[k];
    }
    return elastic > 0 && force > 0 ? force : 0;
  }

 private:
  Relaxation relaxation_;
  std::array<double, Relaxation::kParts> past_{};  ///< [N]
};

/// A simulated tissue: a plain block with an inclusion somewhere below its surface, or curves at
/// several places.
/// A value; immutable after make_phantom.
struct Phantom {
  std::string name;
  ForceTable plain;              ///< the block beside the inclusion
  ForceTable over;               ///< above the inclusion
  std::optional<double> depth;   ///< [m], top of the inclusion below the undeformed surface
  std::optional<double> radius;  ///< [m]
  std::optional<double> ratio;   ///< [-], stiffness of the inclusion over that of the block
  std::string shape;             ///< "ball", "cylinder", "none" or "unknown"
  Relaxation relaxation{};       ///< of the whole tissue
  Place axis{kSiteB};            ///< where the inclusion lies
  /// All that is known of the tissue, where that is more than one curve; then `plain` and `over`
  /// are the softest and the stiffest of them. Empty: those two.
  std::vector<PlacedCurve> survey{};

  [[nodiscard]] double depth_max() const noexcept;  ///< [m], where all tables still hold
};

/// The phantom as a field; `viscous_factor` as there. The phantom outlives it.
[[nodiscard]] std::unique_ptr<TissueField> make_field(const Phantom& phantom,
                                                      double viscous_factor);

/// `paper-5mm|paper-10mm|paper-15mm|paper-20mm|paper-25mm|none`, `closed-form[:DEPTH_MM]`,
/// `exponential[:DEPTH_MM]`, `relaxing[:DEPTH_MM]`, `draining[:DEPTH_MM]`, `layered[:DEPTH_MM]`
/// (analytic laws for checks, not tissues), `random:SEED` (see drawn_tissue), `file:PATH.csv` (see
/// load_tissue_curves: one curve is that above an inclusion, at B unless it says where, in the
/// paper's plain block), or from the depth database `ball depth=12 radius=8 ratio=200 at=20,0`
/// (also `cylinder`; lengths and place in mm). Everything else gives a sentence.
[[nodiscard]] Result<Phantom> make_phantom(std::string_view spec);

/// All tables as CSV text, columns `x_mm,y_mm,d_mm,F_N`, the plain block at A: what a session file
/// keeps of its tissue.
[[nodiscard]] std::string tissue_csv(const Phantom& phantom);

}  // namespace palp::patient
