#pragma once

#include <algorithm>
#include <cmath>

namespace palp::coupling {

struct PortTankConfig {
  double start{1e-3};  ///< [J], and the guarantee: the most the hand can ever gain
  double most{30e-3};  ///< [J], that can come back at once
  double spring{650};  ///< [N/m], through which it is given; > tissue's, so that those are not cut
};

/// What a law knows by itself, whatever it is told: the work that went through the hand's port,
/// with the force that was really applied. A force no larger than that of a spring which the tank
/// could have drawn falls with the tank, along the spring: the hand gets no more than the tank held
/// at first and what it put in. Thread: rt. A value.
class PortTank {
 public:
  explicit PortTank(const PortTankConfig& config) noexcept
      : config_{config}, level_{config.start} {}

  /// The axis may have moved under the hand: no work. The level is kept.
  void begin_epoch(double position) noexcept { position_ = position; }  ///< [m]
  /// Once a tick, however late. @returns the hand's way since the last [m].
  double account(double force_applied, double position) noexcept {
    const double way = position - position_;
    position_ = position;
    level_ = std::min(config_.most, level_ + force_applied * way);
    return way;
  }
  [[nodiscard]] double level() const noexcept { return level_; }  ///< [J]
  [[nodiscard]] double force_max() const noexcept {               ///< [N]
    return std::sqrt(2 * config_.spring * std::max(0.0, level_));
  }

 private:
  PortTankConfig config_;
  double level_;       ///< [J]
  double position_{};  ///< [m]
};

}  // namespace palp::coupling
