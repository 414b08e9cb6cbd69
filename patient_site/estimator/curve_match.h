#pragma once

#include <array>

#include "common/core/matrix3.h"
#include "patient_site/estimator/curve_lattice.h"
#include "patient_site/estimator/normal_equations.h"

namespace palp::estimator {

/// Of Young's modulus over that of the database, and of how the force grows with the rate.
struct StiffnessPrior {
  double scale{1};                 ///< [-]
  double scale_stddev{0.1};        ///< [-]
  double rate_factor{0.5};         ///< [s/m]
  double rate_factor_stddev{0.5};  ///< [s/m]
  double correlation{0};           ///< [-], between the two
};

/// How far off the surface may be that a place's strokes were cut with.
inline constexpr double kSurfaceSpread = 0.3e-3;  // [m]

/// How a curve fits the samples of one place. Stiffness, surface and rate factor, in which the
/// force is linear, are integrated out.
struct CurveMatch {
  double log_likelihood{};   ///< [-]
  double misfit{};           ///< [-], sum of weighted squares
  StiffnessPrior stiffness;  ///< as the samples leave it
  double shift{};            ///< [m], of the surface, into the tissue
};

/// Compares curves with what was felt at one place. A value. Thread: estimator.
class CurveMatcher {
 public:
  /// `surface`: where it is expected [m].
  CurveMatcher(const NormalEquations& sums, const StiffnessPrior& stiffness, double surface);

  [[nodiscard]] CurveMatch match(const CurveTerms& curve) const noexcept;

  /// Fisher information of the coordinates of a curve: `along[i]` is the curve's derivative by
  /// coordinate i. Stiffness, surface and rate factor are unknown as well.
  using Information = std::array<std::array<double, 3>, 3>;
  [[nodiscard]] Information information(const CurveTerms& curve,
                                        const std::array<CurveTerms, 3>& along) const noexcept;

  [[nodiscard]] double weights() const noexcept { return sums_.weights(); }  ///< [1/N^2]

 private:
  [[nodiscard]] Matrix3 normal_matrix(const CurveTerms& curve) const noexcept;

  NormalEquations sums_;
  double scale_;         ///< [-]
  Matrix3 known_{};      ///< of (e, e s, e v) beforehand: information
  Vector3 right_{};      ///< and that times the mean
  double known_square_;  ///< [-]
};

}  // namespace palp::estimator
