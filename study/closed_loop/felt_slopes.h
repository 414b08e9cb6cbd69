#pragma once

#include <cstddef>
#include <vector>

namespace palp::study {

/// What a hand can know of stiffness: its own place and the force it is given, a thousand times a
/// second, and nothing else. For each way in that meets a force: the slope of force over the last
/// stretch before the turn, by least squares. A value.
class FeltSlopes {
 public:
  static constexpr double kContact = 50e-3;  ///< [N], less is no contact
  static constexpr double kFrom = 2.5e-3;    ///< [m] before the turn, where the stretch begins
  static constexpr double kTo = 0.3e-3;      ///< [m] before the turn, where it ends
  static constexpr double kTurned = 0.3e-3;  ///< [m], back from the deepest place
  static constexpr std::size_t kTicksMin = 21;

  /// A tick: `position` [m], + into the tissue; `force` [N], + pushes out.
  void feel(double position, double force);
  /// Logarithms of the slopes [ln N/m], of each way in; a slope that is not above 0 tells nothing
  /// and is left out.
  [[nodiscard]] const std::vector<double>& ln_slopes() const noexcept { return ln_slopes_; }

 private:
  struct Tick {
    double position{};  ///< [m]
    double force{};     ///< [N]
  };
  void turn();

  std::vector<Tick> way_in_;
  std::size_t deepest_at_{};  ///< of them, one past the deepest
  double deepest_{};          ///< [m]
  double highest_{};          ///< [m], since the last turn
  bool going_in_{};
  bool begun_{};
  std::vector<double> ln_slopes_;  ///< [ln N/m]
};

}  // namespace palp::study
