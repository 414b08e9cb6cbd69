#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/check.h"
#include "common/core/lapse.h"

namespace palp::surgeon {

struct ForceGrowthConfig {
  double slew{40};         ///< [N/s] > 0, for no motion ...
  double at_once{0.05};    ///< [N], ... and so much at once: the steps of a sensor are no kicks
  double stiffness{1500};  ///< [N/m], of the stiffest tissue, along the hand's way
  double damping{15};      ///< [N s/m], the most that a law has, as the hand becomes faster
  double memory{0.02};     ///< [s], for which a motion explains a force: a law's filters are slow
};

/// How a force on the hand may grow: as the hand's own motion through the stiffest tissue explains,
/// and by a slew beside. So no lie, no news and no pause is a kick, whatever law believes it. A
/// force that falls is not held up: that would give the hand energy which nobody pays for. Thread:
/// rt. A value.
class ForceGrowth {
 public:
  explicit ForceGrowth(const ForceGrowthConfig& config) : config_{config} {
    PALP_CHECK(config.slew > 0 && config.at_once >= 0 && config.stiffness >= 0 &&
                   config.damping >= 0 && config.memory > 0,
               "a force may grow");
  }

  /// Once a tick. `way`: of the hand since the last one [m], positive into the tissue. Of a late
  /// tick only one period's share explains what is done now.
  void move(double way, const Lapse& lapse) noexcept {
    const double span = seconds(lapse.period);
    const double speed = way / seconds(lapse.passed());
    const double faster = speed - speed_;
    speed_ = speed;
    const double kept = std::max(0.0, 1 - seconds(lapse.passed()) / config_.memory);
    const double pushed = config_.stiffness * speed * span;
    in_ = kept * in_ + std::max(0.0, pushed) + config_.damping * std::max(0.0, faster);
    out_ = kept * out_ + std::max(0.0, -pushed) + config_.damping * std::max(0.0, -faster);
    spare_ = std::min(config_.at_once, spare_ + config_.slew * span);
  }
  /// What moved while the gate was closed explains nothing.
  void forget() noexcept { in_ = out_ = 0; }
  /// From `force` towards `target` [N], which has the same sign and is no smaller.
  [[nodiscard]] double grow(double force, double target) noexcept {
    double& explained = target >= 0 ? in_ : out_;
    const double wanted = std::abs(target) - std::abs(force);
    const double by_motion = std::min(wanted, explained);
    const double beside = std::min(wanted - by_motion, spare_);
    explained -= by_motion;
    spare_ -= beside;
    if (by_motion + beside >= wanted) return target;
    return std::copysign(std::abs(force) + by_motion + beside, target);
  }

 private:
  ForceGrowthConfig config_;
  double speed_{};  ///< [m/s], of the last tick
  double in_{};     ///< [N], by which a force that pushes the hand out may grow
  double out_{};    ///< [N], the same of one that pulls it in
  double spare_{};  ///< [N]
};

}  // namespace palp::surgeon
