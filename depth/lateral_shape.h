#pragma once

#include <vector>

#include "fem/depth_table.h"

namespace palp::depth {

/// What is left of a ball's effect on the force beside its axis: the table of a database,
/// interpolated. Of -ln(g) over the square of the offset, counted in the depth of the ball's
/// centre: nearly one curve for all balls. Cubic with continuous slope in the logarithms of depth
/// and radius, in (k - 1)/(k + 1.5), offset and indentation. A value, immutable. Thread: any.
class LateralShape {
 public:
  /// `table` has passed fem::check().
  explicit LateralShape(const fem::ShapeTable& table);

  /// One ball's, a value of its own.
  struct OfBall {
    double centre{};           ///< [m], depth of the ball's centre
    std::vector<double> fall;  ///< [-], -ln(g) / offset^2, offset slowest, indentation fastest
  };
  /// Outside of the table as at its edge. Depth of the top and radius [m], ratio [-].
  [[nodiscard]] OfBall of(double depth, double radius, double ratio) const;

  /// g: ln(F / F_plain) at `offset` [m] from the axis, on either side, over that on the axis, both
  /// at `indentation` [m]. [-] 1 on the axis; falls all the way, to a thousandth; 0 from kReach on,
  /// where the table's last share has faded. Beyond the table's offsets it goes as the inverse
  /// sixth power. Allocates nothing.
  [[nodiscard]] double share(const OfBall& ball, double offset, double indentation) const noexcept;

  static constexpr double kFadesFrom = 35e-3;  ///< [m]; farther no tip was computed
  static constexpr double kReach = 40e-3;      ///< [m]

 private:
  std::vector<double> depth_axis_;        ///< [-], log of m
  std::vector<double> radius_axis_;       ///< [-], log of m
  std::vector<double> ratio_axis_;        ///< [-], see ratio_coordinate()
  std::vector<double> offset_axis_;       ///< [-], over the depth of the centre
  std::vector<double> indentation_axis_;  ///< [m]
  std::vector<double> fall_;              ///< [-], in the table's order
};

/// What a ball of ratio k does to a uniform strain far from it, up to a constant (Eshelby, nu 0.5).
[[nodiscard]] constexpr double ratio_coordinate(double ratio) noexcept {
  return (ratio - 1) / (ratio + 1.5);
}

}  // namespace palp::depth
