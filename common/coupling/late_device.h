#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/core/device_facts.h"
#include "common/coupling/self_oscillation.h"

namespace palp::coupling {

/// What a law may ask of a haptic device that answers late: a spring pushes harder on the way out
/// than on the way in, and a damping from some gain on drives what it should brake. Of a device of
/// 1 kHz without lag nothing is asked otherwise. Thread: rt. A value.
class LateDevice {
 public:
  LateDevice(const HandFacts& hand, double velocity_cut_off) noexcept
      : late_{answer_delay(hand) > 0},
        velocity_cut_off_{std::min(velocity_cut_off, hand.rate / kReadingsInSpeed)} {
    constexpr double kTurn = 2 * std::numbers::pi;
    const double filter = 1 / (kTurn * velocity_cut_off_) - 1 / (kTurn * velocity_cut_off);
    const double delay = answer_delay(hand) + filter;
    if (delay > 0) damping_most_ = kMassLeast / (2 * delay);
  }

  /// [Hz], of a speed from readings that come in steps.
  [[nodiscard]] double velocity_cut_off() const noexcept { return velocity_cut_off_; }
  /// [N s/m].
  [[nodiscard]] double damping_most() const noexcept { return damping_most_; }
  /// [-], of the tissue's stiffness. How stiff a late spring may be depends on the hand that holds
  /// it, which nobody knows. That it drives this one shows in swings that do not die out, and in an
  /// energy tank that is overdrawn.
  [[nodiscard]] double share() const noexcept { return share_; }
  /// Once a tick. `position` [m] of the hand, `pressed`: against a spring; `tank` [J]; `passed` [s]
  /// since the last one.
  void look(double position, bool pressed, double tank, double passed) noexcept {
    if (!late_) return;
    if (tank < -kNothing) {
      share_ *= std::exp(-passed / kFall);
    } else {
      share_ += (1 - share_) * -std::expm1(-passed / kRise);
    }
    if (oscillation_.step(position, pressed, passed)) share_ *= kSofter;
  }

 private:
  static constexpr double kNothing = 1e-9;       // [J], what rounding leaves of an empty tank
  static constexpr double kSofter = 0.6;         // [-], by a swing that does not die out
  static constexpr double kReadingsInSpeed = 6;  // [-]
  static constexpr double kMassLeast = 0.06;     // [kg], a handle and the lightest hand
  static constexpr double kFall = 0.1;           // [s]
  static constexpr double kRise = 60;            // [s], longer than a hold: what swung swings again

  bool late_;
  double velocity_cut_off_;                                       ///< [Hz]
  double damping_most_{std::numeric_limits<double>::infinity()};  ///< [N s/m]
  double share_{1};                                               ///< [-]
  SelfOscillation oscillation_;
};

}  // namespace palp::coupling
