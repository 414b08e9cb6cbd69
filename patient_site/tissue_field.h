#pragma once

#include <span>
#include <vector>

#include "common/core/place.h"
#include "patient_site/force_table.h"

/// A tissue as a field: what force a tip meets anywhere on it. Here by laws between curves that
/// were computed or measured at single places; of balls in a block: block_tissue.h.
namespace palp::patient {

/// Answers for a whole tissue. Immutable; any thread. Allocates nothing after it was made.
class TissueField {
 public:
  /// `viscous_factor` [s/m]: relative growth of the force with the rate of indentation.
  explicit TissueField(double viscous_factor) noexcept : viscous_factor_{viscous_factor} {}
  virtual ~TissueField() = default;
  TissueField(const TissueField&) = delete;
  TissueField& operator=(const TissueField&) = delete;

  /// [N] >= 0, of a tip that stands `indentation` [m] deep; 0 above the surface.
  [[nodiscard]] virtual double elastic_force(const Place& place,
                                             double indentation) const noexcept = 0;
  /// [N/m], how that force grows with the indentation.
  [[nodiscard]] virtual double stiffness(const Place& place, double indentation) const noexcept = 0;

  /// [m], where the tip touches the undeformed surface: > 0 deeper than the plane of the stage.
  [[nodiscard]] virtual double surface(const Place& /*place*/) const noexcept { return 0; }

  /// [N] >= 0, of a tip that sinks in at `rate` [m/s].
  [[nodiscard]] double force(const Place& place, double indentation, double rate) const noexcept {
    const double moving = elastic_force(place, indentation) * growth(rate);
    return moving > 0 ? moving : 0;
  }
  /// [-], of the force at `rate` [m/s] over that at rest.
  [[nodiscard]] double growth(double rate) const noexcept { return 1 + viscous_factor_ * rate; }

 private:
  double viscous_factor_;  ///< [s/m]
};

/// How much of what an inclusion adds is left at `distance` [m] along the surface from its axis:
/// (1 - (distance/R)^2)^3 with R = kInclusionReach, 0 beyond. 1 on the axis, falling all the way,
/// with continuous slope and curvature.
///
/// A stand-in, for the paper's phantoms and cylinders: what finite elements give for a ball
/// (block_tissue.h) falls more slowly. For the paper's, 15 mm of radius 10 mm deep, they have 0.97,
/// 0.89, 0.63 and 0.19 at 2.5, 5, 10 and 20 mm, this 0.92, 0.70, 0.17 and 0. It ends on purpose
/// before site A, 20 mm from B, which so stays the plain reference that the paper compares with.
[[nodiscard]] double inclusion_share(double distance) noexcept;
inline constexpr double kInclusionReach = 15e-3;  ///< [m]

/// A plain block with one inclusion: ln F = ln F_plain + share (ln F_over - ln F_plain) at equal
/// indentation, exactly one of the two curves on the axis and beyond the reach. Every F counts 1 mN
/// more here, so that a curve may be 0.
class InclusionField final : public TissueField {
 public:
  /// Both tables outlive the field. `axis`: where the inclusion lies.
  InclusionField(const ForceTable& plain,
                 const ForceTable& over,
                 const Place& axis,
                 double viscous_factor) noexcept
      : TissueField{viscous_factor}, plain_{plain}, over_{over}, axis_{axis} {}

  [[nodiscard]] double elastic_force(const Place& place,
                                     double indentation) const noexcept override;
  [[nodiscard]] double stiffness(const Place& place, double indentation) const noexcept override;

 private:
  const ForceTable& plain_;
  const ForceTable& over_;
  Place axis_;
};

/// A tissue of which curves at several places are known. Between them ln(F + 1 mN) at equal
/// indentation is interpolated: each place has a plane through its own value, with the slope that
/// its nearest neighbours say and that levels off from the distance to the nearest on, and planes
/// count by the inverse fourth power of the distance (Shepard 1968, with the planes of Franke and
/// Nielson 1980; by the second power all far places together outweigh the near ones). Exactly the
/// curves at their places, and nowhere more or less than all of them; its slope is continuous where
/// it is not held at the least or the most. Far away, a mean of all.
class SurveyField final : public TissueField {
 public:
  /// `curves`: 2 to kPlacesMax, kPlacesApart or more from each other; outlive the field.
  SurveyField(std::span<const PlacedCurve> curves, double viscous_factor);

  [[nodiscard]] double elastic_force(const Place& place,
                                     double indentation) const noexcept override;
  [[nodiscard]] double stiffness(const Place& place, double indentation) const noexcept override;

  static constexpr std::size_t kNeighboursMax = 8;  ///< that say how the force slopes at a place

 private:
  /// How far the value changes per metre to either side for each unit that a neighbour's is above
  /// the own.
  struct Neighbour {
    std::size_t index{};
    double along_x{};  ///< [1/m]
    double along_y{};  ///< [1/m]
  };
  struct Node {
    std::vector<Neighbour> neighbours;
    double nearest{};  ///< [m]
  };
  /// What each curve counts at a place: together 1, some perhaps below 0. @returns the index of a
  /// curve that is alone there, or the number of curves.
  [[nodiscard]] std::size_t weigh(const Place& place, std::span<double> weights) const noexcept;
  [[nodiscard]] Node node_of(std::size_t index) const;
  struct Blend {
    double log{};              ///< [ln N], of the force
    const ForceTable* held{};  ///< the curve that counts alone: there, or the least or the most
  };
  /// `weights`: room for as many as there are curves.
  [[nodiscard]] Blend blend(const Place& place,
                            double indentation,
                            std::span<double> weights) const noexcept;

  std::span<const PlacedCurve> curves_;
  std::vector<Node> nodes_;
};

}  // namespace palp::patient
