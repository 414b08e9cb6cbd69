#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "depth/curve_lattice.h"
#include "depth/depth_database.h"

namespace palp::depth {

/// A curve by its values at fixed indentations, Chebyshev's over 0 to kCurveReach: as many as it
/// has terms, so that one says what the other does.
inline constexpr std::size_t kCurveNodes = kCurveTerms;
using NodalCurve = std::array<double, kCurveNodes>;

/// The node by which a whole curve is judged roughly: 2.3 mm.
inline constexpr std::size_t kMiddleNode = 3;

[[nodiscard]] const NodalCurve& node_indentations() noexcept;  ///< [m], rising
/// terms of a curve = sum over nodes of its value * node_terms()[node].
[[nodiscard]] const std::array<CurveTerms, kCurveNodes>& node_terms() noexcept;

/// What is left of a ball's effect `offset` [m] beside its axis, `indentation` [m] deep: g of
/// ln(F/F_plain) = g * (what it is on the axis). 1 on the axis, falling to 0.
using LateralShare =
    std::function<double(const DepthDatabase::Query& ball, double offset, double indentation)>;

/// By the table of the database, which outlives it. A database without one: the closed form of a
/// small ball in an incompressible half space, g = (1 + (offset/depth of the centre)^2)^-3.
[[nodiscard]] LateralShare lateral_share(const DepthDatabase& database);

/// The forces beside a ball, over those of the plain block, everywhere on a plane surface: the
/// curve on its axis from the depth database, times what is left beside the axis. So dense a table
/// that cubics (on the axis) and lines (beside it) between its points are as good as the database.
/// A value, immutable after construction. Thread: any.
class BallField {
 public:
  BallField(const DepthDatabase& database, const DepthPrior& prior, const LateralShare& share);

  /// One ball, from above.
  class Ball {
   public:
    /// F/F_plain at the nodes, `offset` [m] beside the axis. [-]
    [[nodiscard]] NodalCurve ratio(double offset) const noexcept;
    /// ln(F/F_plain) at the nodes on the axis. [-]
    [[nodiscard]] const NodalCurve& excess() const noexcept { return excess_; }

   private:
    friend class BallField;
    static constexpr std::size_t kOffsets = 17;
    double centre_{};                          ///< [m], below the surface
    NodalCurve excess_{};                      ///< [-]
    std::array<NodalCurve, kOffsets> fall_{};  ///< [-], -ln(g) / (offset/centre)^2
  };
  [[nodiscard]] Ball at(double log_depth, double radius, double effect) const noexcept;

  [[nodiscard]] const CurveLattice& lattice() const noexcept { return lattice_; }

 private:
  CurveLattice lattice_;
  NodeAxis depth_;                                             ///< log of m
  NodeAxis radius_;                                            ///< [m]
  NodeAxis effect_;                                            ///< [-]
  std::vector<std::array<NodalCurve, Ball::kOffsets>> falls_;  ///< by radius, effect, depth
};

}  // namespace palp::depth
