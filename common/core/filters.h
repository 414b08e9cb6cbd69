#pragma once

#include <cstdint>

/// Small discrete filters used on both sites. Values: copy them freely. Thread: their owner's.
namespace palp {

/// First-order low pass, sampled: y += a (u - y), a = 1 - exp(-2 pi f dt).
class LowPass {
 public:
  /// `cut_off` [Hz] > 0, `period` [s] > 0.
  LowPass(double cut_off, double period) noexcept;
  void reset(double value) noexcept { value_ = value; }
  double step(double input) noexcept { return value_ += gain_ * (input - value_); }
  /// As `periods` >= 1 steps of the same input.
  double step(double input, std::int64_t periods) noexcept;
  [[nodiscard]] double value() const noexcept { return value_; }
  [[nodiscard]] double gain() const noexcept { return gain_; }

 private:
  double gain_;     ///< [-]
  double value_{};  ///< [unit of the input]
};

/// Rate of a sampled position [m] through a low pass: [m/s]. The first sample gives 0. A sample
/// that comes `periods` after the one before is the end of an even motion in between.
class VelocityEstimate {
 public:
  VelocityEstimate(double cut_off, double period) noexcept;
  void reset() noexcept;
  double step(double position, std::int64_t periods = 1) noexcept;
  [[nodiscard]] double value() const noexcept { return filter_.value(); }

 private:
  LowPass filter_;
  double period_;      ///< [s]
  double previous_{};  ///< [m]
  bool started_{};
};

}  // namespace palp
