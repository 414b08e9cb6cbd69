#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fem/depth_database.h"
#include "patient_site/estimator/contact_curve.h"
#include "patient_site/estimator/curve_lattice.h"

namespace palp::estimator {

/// Of Young's modulus over that of the database, and of how the force grows with the rate.
struct StiffnessPrior {
  double scale{1};                 ///< [-]
  double scale_stddev{0.1};        ///< [-]
  double rate_factor{0.5};         ///< [s/m]
  double rate_factor_stddev{0.5};  ///< [s/m]
};

/// How far off the surface may be that a place's strokes were cut with.
inline constexpr double kSurfaceSpread = 0.3e-3;  // [m]
/// The points of a stroke count to here: what the filters did is known to there.
inline constexpr double kDeepestPoint = 4.05e-3;  // [m]

/// How a curve fits the points of one place. Stiffness, surface and rate factor, in which the force
/// is linear, are integrated out.
struct CurveMatch {
  double log_likelihood{};      ///< [-]
  double misfit{};              ///< [-], sum of weighted squares
  double scale{};               ///< [-]
  double scale_stddev{};        ///< [-]
  double rate_factor{};         ///< [s/m]
  double rate_factor_stddev{};  ///< [s/m]
  double shift{};               ///< [m], of the surface, into the tissue
};

/// The force of the block without inclusion, tabulated, times the polynomials of CurveTerms.
/// A value, immutable after construction.
class CurveBasis {
 public:
  explicit CurveBasis(const fem::DepthDatabase& database);
  struct Row {
    CurveTerms force{};  ///< [N]
    CurveTerms slope{};  ///< [N/m]
  };
  [[nodiscard]] Row at(double indentation) const noexcept;  ///< [m]; zero in the air

 private:
  std::vector<Row> rows_;
};

/// The points of one place seen from one surface, reduced to what every curve needs of them: a
/// match then costs some hundred multiplications, however many points there are.
/// A value. Thread: estimator.
class CurveMatcher {
 public:
  struct Input {
    std::span<const ContactPoint> points;
    double surface{};  ///< [m], near it
    double noise{};    ///< [N], rms of one sample
    StiffnessPrior stiffness;
  };
  CurveMatcher(const CurveBasis& basis, const Input& input);

  [[nodiscard]] CurveMatch match(const CurveTerms& curve) const noexcept;

  /// Fisher information of the coordinates of a curve: `along[i]` is the curve's derivative by
  /// coordinate i. Stiffness, surface and rate factor are unknown as well.
  using Information = std::array<std::array<double, 3>, 3>;
  [[nodiscard]] Information information(const CurveTerms& curve,
                                        const std::array<CurveTerms, 3>& along) const noexcept;

  [[nodiscard]] double weights() const noexcept { return weights_; }  ///< [1/N^2], of all points

 private:
  using Form = std::array<CurveTerms, kCurveTerms>;
  void add(const CurveBasis& basis, const ContactPoint& point, double indentation);

  double noise_;  ///< [N]
  StiffnessPrior stiffness_;
  double weights_{};                            ///< [1/N^2]
  double squares_{};                            ///< [-], of the measured force
  std::array<std::array<Form, 3>, 3> forms_{};  ///< by unknown and unknown
  std::array<CurveTerms, 3> right_{};
};

}  // namespace palp::estimator
