#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "patient_site/block_tissue.h"
#include "patient_site/relaxation.h"
#include "patient_site/tissue_field.h"

namespace palp::patient {

/// A simulated tissue: a plain block with an inclusion below one place, curves at several places,
/// or a block that answers everywhere. A value; immutable after make_phantom.
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
  /// Where the force is known everywhere; then `plain` is its force far from any inclusion and
  /// `over`, depth, radius, ratio, shape and axis are those of its first.
  std::optional<BlockTissue> block{};
  std::string words{};                 ///< of `block`, as read
  std::optional<double> tip_radius{};  ///< [m], of which the forces are; nothing: nobody said
  std::string caution{};               ///< one sentence on what nobody asked for; empty: none

  [[nodiscard]] double depth_max() const noexcept;  ///< [m], where all tables still hold
};

/// The phantom as a field; `viscous_factor` as there. The phantom outlives it.
[[nodiscard]] std::unique_ptr<TissueField> make_field(const Phantom& phantom,
                                                      double viscous_factor);

/// `paper-5mm|paper-10mm|paper-15mm|paper-20mm|paper-25mm|none`, `closed-form[:DEPTH_MM]`,
/// `exponential[:DEPTH_MM]`, `relaxing[:DEPTH_MM]`, `draining[:DEPTH_MM]`, `layered[:DEPTH_MM]`
/// (analytic laws for checks, not tissues), `random:SEED` (see drawn_tissue), the words of a tissue
/// (tissue_words.h: `ball depth=12 radius=8 ratio=200 at=20,0; block e_kpa=18`), or `file:PATH`:
/// such words, or curves (see load_tissue_curves). One curve alone is that above an inclusion, at B
/// unless it says where; what lies beside it says `file:PATH beside=paper` or `beside=PATH`. All
/// else gives a sentence.
[[nodiscard]] Result<Phantom> make_phantom(std::string_view spec);

/// All tables as CSV text, columns `x_mm,y_mm,d_mm,F_N`, of a block those at A and above each
/// inclusion, else the plain block at A: what a session file keeps of its tissue.
[[nodiscard]] std::string tissue_csv(const Phantom& phantom);

}  // namespace palp::patient
