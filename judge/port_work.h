#pragma once

#include <optional>

namespace palp::judge {

/// Work that crossed a port, from samples of it: force over way, so that samples that are missing
/// take away no work. Of one port either all forces are applied ones or all are readings.
/// Thread: any one.
class PortWork {
 public:
  /// In order of time: `position` [m], and the `force` [N], against the way inwards, that a device
  /// held since the sample before; both finite.
  void add_applied(double position, double force) noexcept {
    if (last_) work_ += force * (position - last_->position);
    last_ = Sample{position, force};
  }
  /// Likewise: between two readings a force goes straight.
  void add_reading(double position, double force) noexcept {
    if (last_) work_ += 0.5 * (last_->force + force) * (position - last_->position);
    last_ = Sample{position, force};
  }
  /// [J], into the port since the first sample.
  [[nodiscard]] double work() const noexcept { return work_; }

 private:
  struct Sample {
    double position{};  ///< [m]
    double force{};     ///< [N]
  };
  std::optional<Sample> last_;
  double work_{};  ///< [J]
};

}  // namespace palp::judge
