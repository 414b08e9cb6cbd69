#pragma once

#include <complex>
#include <string_view>

#include "common/core/time.h"
#include "common/coupling/any_coupling.h"

/// A coupling as a two-port: between a hand that is moved as told and a stage, over a path that
/// only delays. Pure, in virtual time; no gates and no supervisors. Signs: conventions.h, so that
/// the hand puts in F_h v_h and the tissue takes F_c v_s.
namespace palp::lab {

struct TwoPortSetup {
  coupling::CouplingConfig coupling{};
  double round_trip{};       ///< [s], 0 to 10; half of it each way
  double frequency{1};       ///< [Hz], 0.1 to 100
  double amplitude{0.2e-3};  ///< [m], of the hand, > 0
};

/// Force over velocity [N s/m] of one frequency: a spring k has k/(i 2 pi f), a damper b has b.
using Impedance = std::complex<double>;

/// What the hand feels while the tip is in a spring of `stiffness` [N/m]: it taps three times, goes
/// 3 mm deep and swings there. 0: in the air. Of a law that is not linear it is the describing
/// function at this amplitude.
[[nodiscard]] Impedance transmitted_impedance(const TwoPortSetup& setup, double stiffness);

/// [F_h; -v_s] = [h11 h12; h21 h22] [v_h; F_c], in the air, by a hand that swings and a force on
/// the tip that does.
struct HybridMatrix {
  std::complex<double> h11;  ///< [N s/m]
  std::complex<double> h12;  ///< [-]
  std::complex<double> h21;  ///< [-]
  std::complex<double> h22;  ///< [m/(N s)]
};
[[nodiscard]] HybridMatrix hybrid_matrix(const TwoPortSetup& setup);

/// Llewellyn's criterion: with passive hands and tissues whatever a linear two-port is stable at
/// this frequency if both real parts are >= 0 and `margin` is >= 1.
struct AbsoluteStability {
  double hand{};    ///< [N s/m], Re h11
  double tissue{};  ///< [m/(N s)], Re h22
  double margin{};  ///< [-], (2 Re h11 Re h22 - Re h12 h21)/|h12 h21|; infinite: nothing crosses
  /// Within `tolerance` [-], relative, for numbers that are measured.
  [[nodiscard]] bool holds(double tolerance = 1e-3) const noexcept;
};
[[nodiscard]] AbsoluteStability absolute_stability(const HybridMatrix& of) noexcept;

/// Only of these laws the criterion says anything: the others are not linear.
[[nodiscard]] bool is_linear(std::string_view coupling) noexcept;

}  // namespace palp::lab
