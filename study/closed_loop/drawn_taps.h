#pragma once

#include <vector>

namespace palp::study {

/// What eyes and the own hand know of stiffness where the tip's force is drawn: for each touch the
/// greatest force that was drawn, over how deep the hand went. Nothing of that depends on how late
/// it is drawn. A value.
class DrawnTaps {
 public:
  static constexpr double kContact = 50e-3;  ///< [N], less is not seen

  /// `step` [N] of what is drawn, that of the sensor; 0: none.
  explicit DrawnTaps(double step) noexcept : step_{step} {}

  /// A tick: `position` [m] of the hand, + into the tissue; `force` [N] at the tip.
  void see(double position, double force);
  /// Logarithms of force over depth [ln N/m], of each touch that has ended.
  [[nodiscard]] const std::vector<double>& ln_stiffness() const noexcept { return ln_stiffness_; }

 private:
  double step_;                       ///< [N]
  double most_{};                     ///< [N], of this touch
  double deepest_{};                  ///< [m], since the last touch ended
  std::vector<double> ln_stiffness_;  ///< [ln N/m]
};

}  // namespace palp::study
