#pragma once

#include "common/core/device_facts.h"

namespace palp::coupling {

struct ReleaseLineConfig {
  double way{0.2e-3};     ///< [m], over which a force lets go, within the two limits that follow
  double soft{1500};      ///< [N/m], it always may be so steep
  double steepest{4000};  ///< [N/m], what a device of 1 kHz and the damping of a grip bear
  double play{60e-6};     ///< [m], that a holding hand trembles and its encoder counts
  double settle{0.1};     ///< [s], after which the play lies where the hand rests
  double period{1e-3};    ///< [s], of the calls of hold()
};

/// A device that answers late drives a hand the more, the steeper the line: it gets the soft one.
[[nodiscard]] ReleaseLineConfig at_device(ReleaseLineConfig line, const HandFacts& hand) noexcept;

/// How a force lets go of a hand where nobody can pay for the spring behind it. Holding a force
/// takes no energy, giving way does, so the force follows a steep line that stores little: it stays
/// for a play, and falls beyond it. The way back is the way out. A line with a hysteresis would
/// take energy with each tremble. Thread: rt. A value.
class ReleaseLine {
 public:
  explicit ReleaseLine(const ReleaseLineConfig& config) noexcept : config_{config} {}

  /// The spring itself is paid for, or there is no force.
  void end() noexcept { stiffness_ = force_ = plateau_ = 0; }
  /// The hand moved by `moved` [m], positive into the tissue.
  void move(double moved) noexcept;
  /// `force` >= 0 [N] is given here and now, with `energy` [J] behind it, at least `least(force)`.
  void hold(double force, double energy) noexcept;

  [[nodiscard]] bool holds() const noexcept { return stiffness_ > 0; }
  [[nodiscard]] double force() const noexcept { return force_; }  ///< [N], while it holds
  /// [J], what the hand could take as the force pushes it out, while it holds.
  [[nodiscard]] double energy() const noexcept {
    return 0.5 * force_ * force_ / stiffness_ + force_ * slack_;
  }
  /// [J], that `force` [N] must store here.
  [[nodiscard]] double least(double force) const noexcept;

 private:
  [[nodiscard]] double steepest(double force) const noexcept;

  ReleaseLineConfig config_;
  double stiffness_{};  ///< [N/m], 0: it does not hold
  double force_{};      ///< [N]
  double plateau_{};    ///< [N], of the play
  double slack_{};      ///< [m], 0 to `play`: so far out the force stays
};

}  // namespace palp::coupling
