#pragma once

#include <cmath>

#include "common/core/time.h"

namespace palp::patient {

struct ServoWatchConfig {
  double error{1e-3};    ///< [m], from an axis to its target: a servo is on its way
  double still{0.1e-3};  ///< [m]: that is no way
  Duration time{std::chrono::milliseconds{300}};  ///< so long: it does not follow
};

/// Whether an axis goes where it is sent. One that stands still away from its target does not, nor
/// one that moves elsewhere; one that comes closer does, however late. Thread: one. A value.
class ServoWatch {
 public:
  explicit ServoWatch(const ServoWatchConfig& config = {}) noexcept : config_{config} {}

  void reset() noexcept { begun_ = false; }
  /// Once a period. `position`, `target`: [m]; `period`: what this look proves, also where it comes
  /// late: nothing was looked at in between. @returns true: it did not follow for too long.
  [[nodiscard]] bool judge(double position, double target, Duration period) noexcept {
    const double error = target - position;
    const double closer = error < 0 ? farthest_ - position : position - farthest_;
    if (!begun_ || closer < 0) farthest_ = position;
    if (!begun_ || closer > config_.still || std::abs(error) <= config_.error) {
      farthest_ = position;
      lost_for_ = Duration{0};
    }
    begun_ = true;
    lost_for_ += period;
    return lost_for_ > config_.time;
  }

 private:
  ServoWatchConfig config_;
  bool begun_{};
  double farthest_{};    ///< [m], from the target, since it came closer last
  Duration lost_for_{};  ///< since then
};

}  // namespace palp::patient
