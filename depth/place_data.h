#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "common/core/place.h"
#include "depth/ball_field.h"
#include "depth/curve_match.h"
#include "depth/normal_equations.h"

namespace palp::depth {

/// How a plain tissue's curve may differ from the block's of the database, everywhere alike:
/// F_plain(d) (1 + a_1 T_1(d) + a_2 T_2(d)), Chebyshev's polynomials over 0 to kCurveReach. Tissue
/// that stiffens or is layered does; that is no inclusion.
inline constexpr std::size_t kTissueShapes = 2;
inline constexpr std::array<double, kTissueShapes> kTissueShapeSpread{0.15, 0.08};  ///< [-]
[[nodiscard]] const std::array<NodalCurve, kTissueShapes>& tissue_shapes() noexcept;

/// All that the touches at one place say of the tissue there: the logarithm of the likelihood, as a
/// quadratic form of the force's curve (by its nodes, over that of the plain block of the database)
/// and of the rate factor. The surface is integrated out.
struct PlaceData {
  static constexpr std::size_t kSize = kCurveNodes + 1;
  using Row = std::array<double, kSize>;
  Place place;
  std::array<Row, kSize> information{};  ///< [-]; of the rate factor [m^2/s^2] in the last
  Row pull{};                            ///< information times where it is largest, but for priors
  double square{};                       ///< [-], the misfit at 0
  double rate_factor{};                  ///< [s/m], from which the last is counted
  // The place alone, fitted by a curve of any size and shape.
  double scale{1};   ///< [-], of its force
  double surface{};  ///< [m]
  double misfit{};   ///< [-], sum of weighted squares
  double samples{};  ///< [-]
  double force{};    ///< [-], sum of the weighted squares of the force itself
};

/// What a place says of a factor on a force.
struct FactorTold {
  double information{};  ///< [-]
  double pull{};         ///< [-], that times the factor
};
/// `force` [-]: over that of the plain block of the database; `rate_factor` [s/m].
[[nodiscard]] FactorTold factor_told(const PlaceData& place,
                                     const NodalCurve& force,
                                     double rate_factor) noexcept;

/// What is known of a place before.
struct PlaceReadings {
  Place place;
  std::span<const Touch> touches;
  double surface{};  ///< [m], near it
  double noise{};    ///< [N], rms of one sample, the steps' share included
  double quantum{};  ///< [N], of the transducer; 0: no steps
  double cut_off{};  ///< [Hz], of its pole; 0: none
  StiffnessPrior stiffness;
};

/// nullopt: nothing was felt there.
[[nodiscard]] std::optional<PlaceData> place_data(const PlaceReadings& readings,
                                                  const CurveBasis& basis);

}  // namespace palp::depth
