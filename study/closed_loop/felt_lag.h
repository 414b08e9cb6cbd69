#pragma once

#include <optional>
#include <vector>

namespace palp::study {

/// What a hand can know of a delay: by how long the force that it is given and its own place are
/// out of step. Near the turn of a tap the force is taken for that of a spring and a damper, b over
/// k, by least squares. A tissue that answers late takes energy less than a spring does (b < 0); a
/// law that holds the hand back until the tip has come takes more (b > 0). Either is noticed
/// (Rank, Shi, Mueller and Hirche 2010 have delays of springs, dampers and masses). A value.
class FeltLag {
 public:
  static constexpr double kReach = 2.5e-3;       ///< [m], before the deepest place
  static constexpr std::size_t kTicksMin = 100;  ///< with a force, or nothing is known
  static constexpr double kForce = 50e-3;        ///< [N], the most has to be above it
  static constexpr double kLagMax = 250;         ///< [ms], a quarter of a tap: no step is left

  /// A tick, a thousand a second: `position` [m], + into the tissue; `force` [N], + pushes out.
  void feel(double position, double force) { ticks_.push_back({position, force}); }
  /// |b / k| [ms], kLagMax where the force does not grow with depth; nothing where hardly any was
  /// met.
  [[nodiscard]] std::optional<double> lag() const;

 private:
  struct Tick {
    double position{};  ///< [m]
    double force{};     ///< [N]
  };

  std::vector<Tick> ticks_;
};

}  // namespace palp::study
