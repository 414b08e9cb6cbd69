#pragma once

#include <array>
#include <cstddef>

#include "common/core/small_solver.h"
#include "common/coupling/contact_model.h"

/// The part of a contact model that no sum of its smooth shapes describes.
namespace palp::coupling {

/// Keeps what force the tip met at each height, whatever the law, and fits a stiffness >= 0 at
/// each knot to it: least squares with the smooth shapes as prior, so that they stay where nothing
/// was felt. Says how much of it is worth telling: where the smooth shapes leave no more than
/// noise, nothing. Heights pass the transducer's pole as the force did. Thread: rt; constant
/// memory, bounded work. A value.
class SplineEstimator {
 public:
  /// What relaxes, and damping: see ContactEstimator.
  static constexpr std::size_t kBeside = kModelTimes.size() + 1;
  using Factors = std::array<double, kBeside>;
  /// The force [N], and what of it each factor takes.
  using Met = std::array<double, 1 + kBeside>;

  /// Forgets everything; `lowest` [m] is where the heights begin, the tip is at `position` [m].
  void begin(double lowest, double position) noexcept;
  /// Before anything was felt here: as it was elsewhere, with the share that was told of it.
  void expect(const KnotStiffness& stiffness, double share) noexcept;
  /// Once a tick: the tip's `position` [m]; `gain` [-], of the pole, per tick.
  void follow(double position, double gain) noexcept;
  /// What was followed before is part of no equation.
  void begin_equation() noexcept;
  /// What was followed since then met `met`, on average. It counts `weight` [-], and what was
  /// before `keep` [-] of what it did.
  void add(const Met& met, double weight, double keep) noexcept;
  /// Beside `smooth`, with these factors of what is not elastic, where an equation has `noise`
  /// [N^2]. @returns how much less than `smooth` it leaves of the sum of squares [N^2].
  double fit(const ContactModel& smooth, const Factors& factors, double noise) noexcept;
  /// Nothing is told until the next fit.
  void drop() noexcept { share_ = expected_share_ = 0; }

  /// [-], 0 to 1, of the spline; the rest is the smooth shapes'.
  [[nodiscard]] double share() const noexcept { return share_; }
  [[nodiscard]] const KnotStiffness& stiffness() const noexcept { return stiffness_; }  ///< [N/m]

 private:
  static constexpr std::size_t kNodes = 44;
  static constexpr double kNodeStep = 0.25e-3;  ///< [m]
  static constexpr std::size_t kKnots = kModelKnots.size();
  using Nodes = std::array<double, kNodes>;
  using Ramps = std::array<Nodes, kKnots>;  ///< [m], the force at the nodes of 1 N/m at each knot

  [[nodiscard]] double depth_of(std::size_t node, double surface) const noexcept {
    return lowest_ + kNodeStep * static_cast<double>(node) - surface;
  }
  [[nodiscard]] Nodes elastic(const Factors& factors) const noexcept;
  [[nodiscard]] Ramps ramps_under(double surface) const noexcept;
  [[nodiscard]] SmallSystem<kKnots> equations(const Ramps& ramps,
                                              const Nodes& right) const noexcept;
  [[nodiscard]] double cost_of(const Nodes& force, const Nodes& right) const noexcept;

  double lowest_{};                         ///< [m], of the first node
  Nodes hats_{};                            ///< [-], of straight lines from node to node; filtered
  Nodes passed_{};                          ///< [-], summed since begin_equation()
  double count_{};                          ///< [-], ticks, likewise
  std::array<Nodes, kNodes> normal_{};      ///< [-]
  std::array<Nodes, 1 + kBeside> right_{};  ///< [N], of each part of what was met
  KnotStiffness stiffness_{};               ///< [N/m]
  double share_{};                          ///< [-]
  KnotStiffness expected_{};                ///< [N/m]
  double expected_share_{};                 ///< [-]
};

}  // namespace palp::coupling
