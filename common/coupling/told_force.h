#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/lapse.h"
#include "common/core/limits.h"

namespace palp::coupling {

struct ToldForceConfig {
  double slew{22};          ///< [N/s], while the hand stands still
  double stiffness{370};    ///< [N/m], of the stiffest tissue: along the hand's way
  double repay_time{0.05};  ///< [s], in which what was held back is given after all
  double owed_max{0.005};   ///< [N s], of it; more is forgotten
};

/// The part of the hand's force that the other end has a say in. It follows what that end says no
/// faster than the stiffest tissue along the hand's way explains, and 22 N/s beside: no news, no
/// lie and no pause is a kick. What was held back comes later, because the sum over time of a
/// wave's force is a way: without it hand and tip would drift apart. Thread: rt. A value.
class ToldForce {
 public:
  explicit ToldForce(const ToldForceConfig& config) noexcept : config_{config} {}

  /// No force, and nothing owed.
  void begin_epoch() noexcept { force_ = owed_ = 0; }
  /// Another limit has the last word [N]; what it takes is not owed.
  void cut_to(double force) noexcept { force_ = force; }
  /// Once a tick. `way`: of the hand since the last one [m]. Of the way of a late tick only one
  /// period's share explains what is done now.
  double step(double wanted, double way, const Lapse& lapse) noexcept {
    const double span = seconds(lapse.period);
    const double moved = std::abs(way) * span / seconds(lapse.passed());
    const double target = wanted + owed_ / config_.repay_time;
    force_ = step_towards(force_, target, config_.slew * span + config_.stiffness * moved);
    owed_ = std::clamp(owed_ + (wanted - force_) * span, -config_.owed_max, config_.owed_max);
    return force_;
  }

 private:
  ToldForceConfig config_;
  double force_{};  ///< [N]
  double owed_{};   ///< [N s], wanted less given
};

}  // namespace palp::coupling
