#pragma once

#include <array>
#include <cstddef>

namespace palp::depth {

/// What a transducer's rounding to steps makes of a force with white noise on it: the noise dithers
/// the steps but does not quite remove them. A value, immutable after construction.
class SensorSteps {
 public:
  /// `noise`: rms of a sample's error [N], the steps' share included. `quantum` [N]; 0: no steps.
  /// Where the noise is smaller than steps could be, there are none.
  SensorSteps(double noise, double quantum);

  struct Reading {
    double offset{};    ///< [N], mean of the reading minus the force
    double slope{};     ///< [-], of that mean by the force
    double variance{};  ///< [N^2], of the reading
  };
  [[nodiscard]] Reading at(double force) const noexcept;  ///< [N]

 private:
  static constexpr std::size_t kPhases = 128;
  double quantum_;                            ///< [N]; 0: no steps
  std::array<Reading, kPhases + 1> table_{};  ///< over one step
};

}  // namespace palp::depth
