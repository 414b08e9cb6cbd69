#pragma once

#include <cmath>
#include <cstdint>

#include "common/core/time.h"
#include "patient_site/devices/device_profile.h"

namespace palp::patient {

/// What a force sensor's readings are worth: takes the tare in quiet air, refuses it where
/// something touches, and notices readings that are saturated, not finite, or always the same. The
/// tare is taken once; a sensor that comes back may be pressed. Thread: its device's. A value.
class LoadCheck {
 public:
  enum class Verdict : std::uint8_t { Taring, Good, Saturated, NotFinite, Stuck, Touched };

  explicit LoadCheck(const DeviceInstallation& config) noexcept : config_{config} {}

  /// `force` [N] as the device gives it, at each new reading.
  [[nodiscard]] Verdict take(double force, TimePoint now) noexcept {
    if (!std::isfinite(force)) return Verdict::NotFinite;
    if (!begun_ || force != last_) changed_at_ = now;
    begun_ = true;
    last_ = force;
    if (std::abs(force) >= kFull * config_.force_range) return Verdict::Saturated;
    if (config_.stuck_after > Duration{0} && now - changed_at_ > config_.stuck_after) {
      return Verdict::Stuck;
    }
    return tared_ ? Verdict::Good : tare(force, now);
  }
  /// A new tare with the next readings: after a refusal, where the user wants it.
  void begin_tare() noexcept {
    tared_ = false;
    count_ = 0;
  }
  /// After a gap: sameness before it proves nothing.
  void resume() noexcept { begun_ = false; }

  [[nodiscard]] bool tared() const noexcept { return tared_; }
  [[nodiscard]] double zero() const noexcept { return zero_; }    ///< [N]
  [[nodiscard]] double noise() const noexcept { return noise_; }  ///< [N], rms, in that quiet air

 private:
  static constexpr double kFull = 0.99;  // [-], of the range
  static constexpr std::uint32_t kLeast = 8;

  [[nodiscard]] Verdict tare(double force, TimePoint now) noexcept {
    if (count_ == 0) {
      tare_began_ = now;
      sum_ = square_ = 0;
    }
    ++count_;
    sum_ += force - config_.force_zero;
    square_ += (force - config_.force_zero) * (force - config_.force_zero);
    if (count_ < kLeast || now - tare_began_ < config_.tare_time) return Verdict::Taring;
    const double mean = sum_ / count_;
    noise_ = std::sqrt(std::fmax(0, square_ / count_ - mean * mean));
    count_ = 0;
    if (std::abs(mean) > config_.tare_within || noise_ > config_.tare_noise) {
      return Verdict::Touched;
    }
    zero_ = config_.force_zero + mean;
    tared_ = true;
    return Verdict::Good;
  }

  DeviceInstallation config_;
  bool begun_{};
  bool tared_{};
  double last_{};  ///< [N]
  TimePoint changed_at_{};
  TimePoint tare_began_{};
  std::uint32_t count_{};
  double sum_{};     ///< [N], above the expected zero
  double square_{};  ///< [N^2]
  double zero_{};    ///< [N]
  double noise_{};   ///< [N]
};

}  // namespace palp::patient
