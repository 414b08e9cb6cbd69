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

/// The noise of a transducer with steps, from readings of known forces. Where a force rests in the
/// middle of a step hardly any noise shows, between two steps more than there is; so the errors are
/// kept by where in a step the force was. A value.
class NoiseInSteps {
 public:
  void add(double force, double error, double quantum) noexcept;  ///< [N]; reading minus force
  void add(const NoiseInSteps& other) noexcept;
  [[nodiscard]] bool empty() const noexcept;
  /// [N], rms of a sample's error, the steps' share included, over forces anywhere in a step: what
  /// SensorSteps asks for. The errors' own rms where they are too small for steps of `quantum`.
  [[nodiscard]] double rms(double quantum) const noexcept;

 private:
  static constexpr std::size_t kBins = 16;
  [[nodiscard]] double expected(double dither, double quantum) const noexcept;  ///< [N^2], a sum
  std::array<double, kBins> squares_{};                                         ///< [N^2]
  std::array<double, kBins> counts_{};                                          ///< [-]
};

}  // namespace palp::depth
