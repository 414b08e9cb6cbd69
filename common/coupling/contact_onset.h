#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/device_facts.h"

namespace palp::coupling {

/// By so much a tick's reading moves the mean that a contact is seen by: over 10 ms. [-]
inline constexpr double kMeanGain = 0.1;

/// From which mean force on there is contact. A quick sensor's mean is that of many readings; of a
/// slow one a few that are a step too high would pass for a touch. Thread: any. A value.
class ContactOnset {
 public:
  /// `least` [N], whatever the sensor; `period` [s], of a tick.
  ContactOnset(double least, const ForceSensorFacts& sensor, double period) noexcept {
    const double periods = 1 / (sensor.rate * period);  // that a reading stands for
    const double share = periods > 1.01 ? 1 - std::pow(1 - kMeanGain, periods) : kMeanGain;
    least_ = std::max(least, kClearly * (1 - std::pow(1 - share, kReadings)) * sensor.step);
    deviations_ = std::max(kAtOneKilohertz, kDeviations * std::sqrt(share / (2 - share)));
  }
  /// [N]. `deviation` [N], of a reading in the air.
  [[nodiscard]] double force(double deviation) const noexcept {
    return std::max(least_, deviations_ * deviation);
  }

 private:
  static constexpr double kAtOneKilohertz = 1.4;  ///< [-], of a reading's: six of the mean's there
  static constexpr double kDeviations = 5;        ///< [-], of the mean's, where fewer make it
  static constexpr int kReadings = 4;             ///< on end, a step too high, are no contact
  static constexpr double kClearly = 1.05;        ///< [-], above such a mean
  double least_{};                                ///< [N]
  double deviations_{};                           ///< [-], of a reading's
};

}  // namespace palp::coupling
