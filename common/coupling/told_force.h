#pragma once

#include <cmath>

#include "common/core/lapse.h"
#include "common/core/limits.h"

namespace palp::coupling {

struct ToldForceConfig {
  double slew{25};        ///< [N/s], while the hand stands still
  double stiffness{370};  ///< [N/m], of the stiffest tissue: along the hand's way
};

/// The part of the hand's force that the other end has a say in. It follows what that end says no
/// faster than the stiffest tissue along the hand's way explains, and 25 N/s beside: no news, no
/// lie and no pause is a kick. Thread: rt. A value.
class ToldForce {
 public:
  explicit ToldForce(const ToldForceConfig& config) noexcept : config_{config} {}

  void set(double force) noexcept { force_ = force; }  ///< [N]
  /// Once a tick. `way`: of the hand since the last one [m]. Of the way of a late tick only one
  /// period's share explains what is done now.
  double step(double wanted, double way, const Lapse& lapse) noexcept {
    const double span = seconds(lapse.period);
    const double moved = std::abs(way) * span / seconds(lapse.passed());
    force_ = step_towards(force_, wanted, config_.slew * span + config_.stiffness * moved);
    return force_;
  }

 private:
  ToldForceConfig config_;
  double force_{};  ///< [N]
};

}  // namespace palp::coupling
