#include "common/coupling/sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/coupling/rounding.h"

namespace palp::coupling {
namespace {

using std::numbers::pi;

constexpr std::uint32_t kTicks = 1000;    // 1 s in the air
constexpr std::uint32_t kTicksMin = 200;  // before them nobody knows what noise is
constexpr double kCorrected = 0.4;  // [-], of the steps: of more the correction would run ahead

}  // namespace

void SensorNoise::listen(double force) noexcept {
  if (ticks_ >= 4 * kTicks) return;
  ++ticks_;
  const double share = 1.0 / std::min(ticks_, kTicks);
  square_ += share * (force * force - square_);
}

bool SensorNoise::known() const noexcept { return ticks_ >= kTicksMin; }

double SensorNoise::deviation() const noexcept { return std::sqrt(square_); }

void SensorNoise::settle(double quantum) noexcept {
  if (quantum <= 0) return;
  const double ratio = square_ > 0 ? noise_over_quantum(square_ / (quantum * quantum)) : 0;
  const double left = std::exp(-2 * pi * pi * ratio * ratio);  // of the steps, behind the blur
  if (square_ > 0) dither_ = quantum / pi * std::min(kCorrected, left);
  doubt_ = quantum / 2 * std::max(0.0, left - kCorrected) / (1 - kCorrected);
}

/// First harmonic of the sawtooth, smoothed (Widrow and Kollar, Quantization Noise, ch. 4).
double SensorNoise::bias(double force, double quantum) const noexcept {
  if (dither_ <= 0) return 0;
  return -dither_ * std::sin(2 * pi * force / quantum);
}

}  // namespace palp::coupling
