#pragma once

#include <algorithm>
#include <cmath>

/// The bricks of both gates. All pure or plain values. Thread: their owner's.
namespace palp {

/// `value`, or `otherwise` where it is NaN or infinite.
[[nodiscard]] inline double finite_or(double value, double otherwise) noexcept {
  return std::isfinite(value) ? value : otherwise;
}

/// `target`, but no further than `step_max` >= 0 from `from`.
[[nodiscard]] constexpr double step_towards(double from, double target, double step_max) noexcept {
  return from + std::clamp(target - from, -step_max, step_max);
}

/// A factor between 0 and 1 that moves linearly: full swing in `rise` or `fall` [s], both > 0.
class Ramp {
 public:
  constexpr explicit Ramp(double value = 0) noexcept : value_{value} {}
  constexpr double rise(double dt, double rise_time) noexcept {
    return value_ = std::min(1.0, value_ + dt / rise_time);
  }
  constexpr double fall(double dt, double fall_time) noexcept {
    return value_ = std::max(0.0, value_ - dt / fall_time);
  }
  constexpr void set(double value) noexcept { value_ = value; }
  [[nodiscard]] constexpr double value() const noexcept { return value_; }

 private:
  double value_;  ///< [-]
};

}  // namespace palp
