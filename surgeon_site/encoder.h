#pragma once

#include "common/core/time.h"

namespace palp::surgeon {

/// The encoder of a simulated device: a position in whole steps, and the low-passed rate of them. A
/// value; thread: rt-safe.
class Encoder {
 public:
  Encoder(double step, double cut_off, double position) noexcept;  ///< [m] > 0, [Hz], [m]

  /// The handle is at `position` [m], `span` > 0 after the last time.
  void sample(double position, Duration span) noexcept;

  [[nodiscard]] double position() const noexcept { return position_; }  ///< [m]
  [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< [m/s]

 private:
  [[nodiscard]] double in_steps(double position) const noexcept;

  double step_;            ///< [m]
  double cut_off_;         ///< [Hz]
  double gain_of_period_;  ///< [-], of the low pass for a whole period
  double position_;        ///< [m]
  double velocity_{};      ///< [m/s]
};

}  // namespace palp::surgeon
