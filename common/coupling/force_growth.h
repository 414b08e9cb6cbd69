#pragma once

#include <algorithm>
#include <cmath>

#include "common/core/check.h"
#include "common/core/lapse.h"

namespace palp::coupling {

struct ForceGrowthConfig {
  double slew{40};         ///< [N/s] > 0, for no motion ...
  double at_once{0.05};    ///< [N], ... and so much at once: the steps of a sensor are no kicks
  double stiffness{1500};  ///< [N/m], of the stiffest tissue, along the hand's way
  double damping{15};      ///< [N s/m], the most that a law has, as the hand becomes faster
  double memory{0.02};     ///< [s], for which a motion explains a force: a law's filters are slow
};

/// How a force on the hand may grow: as the hand's own motion through the stiffest tissue explains,
/// and by a slew beside. So no lie, no news and no pause is a kick, whatever law believes it. What
/// is explained is the net motion: a hand that goes to and fro, or an encoder that cannot decide
/// between two counts, explains no more than its swing. A force that falls is not held up, but
/// where somebody asks for that: it gives the hand energy which nobody pays for. Thread: rt. A
/// value.
class ForceGrowth {
 public:
  explicit ForceGrowth(const ForceGrowthConfig& config) : config_{config} {
    PALP_CHECK(config.slew > 0 && config.at_once >= 0 && config.stiffness >= 0 &&
                   config.damping >= 0 && config.memory > 0,
               "a force may grow");
  }

  /// Once a tick. `way`: of the hand since the last one [m], positive into the tissue; `velocity`
  /// [m/s]: as its device says, which smooths it. Of a late tick only one period's share of the way
  /// explains what is done now.
  void move(double way, double velocity, const Lapse& lapse) noexcept {
    const double share = seconds(lapse.period) / seconds(lapse.passed());
    const double kept = std::max(0.0, 1 - seconds(lapse.passed()) / config_.memory);
    const double news = config_.stiffness * way * share + config_.damping * (velocity - velocity_);
    explained_ = std::clamp(kept * explained_ + news, -kMost, kMost);
    velocity_ = velocity;
    spare_ = std::min(config_.at_once, spare_ + config_.slew * seconds(lapse.period));
  }
  /// What moved while the gate was closed explains nothing.
  void forget() noexcept { explained_ = 0; }
  /// From `force` towards `target` [N], by what the hand's way and the slew explain, also where it
  /// falls: for laws that have no energy to keep.
  [[nodiscard]] double change(double force, double target) noexcept {
    const double side = target >= force ? 1 : -1;
    const double wanted = std::abs(target - force);
    const double explained = explain(side, wanted);
    return explained >= wanted ? target : force + side * explained;
  }
  /// The same, but it falls at once.
  [[nodiscard]] double follow(double force, double target) noexcept {
    const double side = target >= 0 ? 1 : -1;
    const double kept = std::min(std::max(0.0, side * force), std::abs(target));
    take_back(force, std::abs(force) - kept);
    const double wanted = std::abs(target) - kept;
    const double explained = explain(side, wanted);
    return explained >= wanted ? target : side * (kept + explained);
  }

 private:
  static constexpr double kMost = 10;  ///< [N], more than a device's peak

  /// Uses up what explains `wanted` [N] more to that side. @returns how much of it.
  [[nodiscard]] double explain(double side, double wanted) noexcept {
    const double by_motion = std::min(wanted, std::max(0.0, side * explained_));
    const double beside = std::min(wanted - by_motion, spare_);
    explained_ -= side * by_motion;
    spare_ -= beside;
    return by_motion + beside;
  }
  /// A force that falls as the hand goes out may come again as the hand comes back.
  void take_back(double force, double fall) noexcept {
    if (force > 0 && explained_ < 0) explained_ = std::min(0.0, explained_ + fall);
    if (force < 0 && explained_ > 0) explained_ = std::max(0.0, explained_ - fall);
  }

  ForceGrowthConfig config_;
  double velocity_{};   ///< [m/s], of the last tick
  double explained_{};  ///< [N], by which a force that pushes the hand out may grow; below 0: one
                        ///< that pulls it in
  double spare_{};      ///< [N]
};

}  // namespace palp::coupling
