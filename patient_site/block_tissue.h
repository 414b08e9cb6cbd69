#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "depth/depth_database.h"
#include "patient_site/plain_laws.h"
#include "patient_site/tissue_field.h"

/// A block with inclusions whose force is known everywhere on its surface.
namespace palp::patient {

inline constexpr double kPaperRadius = 15e-3;  ///< [m], of the ball that reproduces Table I
inline constexpr double kPaperRatio = 13.1e6 / 15.3e3;  ///< [-], paper II.B: 13.1 MPa in 15.3 kPa

/// An inclusion and the place of the surface above it.
struct PlacedInclusion {
  depth::DepthDatabase::Query body;
  Place axis{kSiteB};
};

/// How the surface lies: a plane through the middle of the stage's travel, and on it a dome or a
/// hollow.
struct BlockSurface {
  double slope_x{};    ///< [-], > 0: it rises towards the tip along x
  double slope_y{};    ///< [-]
  double curvature{};  ///< [1/m], > 0: a dome
  Place apex{};        ///< of the dome

  /// Of the surface at a place, towards the tip from the plane of the stage. [m]
  [[nodiscard]] double rise(const Place& place) const noexcept;
  /// How that grows along x and y. [-]
  [[nodiscard]] Place slope(const Place& place) const noexcept;
  [[nodiscard]] bool level() const noexcept {
    return slope_x == 0 && slope_y == 0 && curvature == 0;
  }
};

/// A stiffness that differs from place to place: ln E is a random field, smooth over `length`
/// (correlation exp(-distance^2 / 2 length^2)), the same for the same seed.
struct StiffnessVariation {
  double spread{};       ///< [-], standard deviation of ln E; 0: none
  double length{10e-3};  ///< [m]
  std::uint64_t seed{1};
};

/// What a block is made of. The database says the force without and above an inclusion and what is
/// left of it beside a ball.
struct BlockTissue {
  std::optional<depth::DepthDatabase> database{};  ///< there, once it is to be used
  std::optional<double> youngs_modulus{};  ///< [Pa]; nothing: the database's, or the law's own
  std::optional<double> height{};          ///< [m], thinner than the database's block
  std::optional<PlainLaw> law{};           ///< the block's force in place of the database's
  StiffnessVariation variation{};
  BlockSurface surface{};
  std::vector<PlacedInclusion> inclusions{};
};

/// Whether the database knows its inclusions, none is nearer to another than the smaller one is
/// wide, each lies inside the block, and the surface is as even as it was computed: slopes to
/// 20 degrees, radii of four tips.
[[nodiscard]] Result<void> check(const BlockTissue& tissue);

/// The block's force without inclusions and where E is `youngs_modulus`, across its surface.
/// Errors: of ForceTable::make, where the database presses too little or too hard for a table.
[[nodiscard]] Result<ForceTable> plain_table(const BlockTissue& tissue);

/// The tip comes along the normal of the stage's plane. On a sloping surface
///   F(d) = cos t F_n(d cos t), the contact walking d sin t downhill,
///   F_n(d) = E(place) F_plain(d) exp(sum over inclusions of e(d) g(distance, d)),
/// e = ln F / F_plain above an inclusion and g what is left of it beside a ball, of the database;
/// of a cylinder inclusion_share(), a stand-in. Several inclusions add up, which holds for those
/// far apart. A dome's own force: Sneddon's integrals.
class BlockField final : public TissueField {
 public:
  /// `tissue` has passed check(); it and `plain`, its plain_table(), outlive the field.
  BlockField(const BlockTissue& tissue, const ForceTable& plain, double viscous_factor);

  [[nodiscard]] double elastic_force(const Place& place,
                                     double indentation) const noexcept override;
  [[nodiscard]] double stiffness(const Place& place, double indentation) const noexcept override;
  [[nodiscard]] double surface(const Place& place) const noexcept override;

 private:
  struct Inclusion {
    Place axis;
    double rise{};  ///< [m], of the surface there
    depth::DepthDatabase::Curve curve;
    std::optional<depth::LateralShape::OfBall> shape;  ///< nothing: of a cylinder
  };
  /// One wave of the random field.
  struct Wave {
    double x{};      ///< [rad/m]
    double y{};      ///< [rad/m]
    double phase{};  ///< [rad]
  };
  [[nodiscard]] double log_stiffness(const Place& place) const noexcept;
  [[nodiscard]] double log_excess(const Inclusion& inclusion,
                                  double distance,
                                  double indentation) const noexcept;

  const BlockTissue& tissue_;
  const ForceTable& plain_;
  double tip_radius_;  ///< [m]
  std::vector<Inclusion> inclusions_;
  std::vector<Wave> waves_;
};

}  // namespace palp::patient
