#include "patient_site/force_foresight.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palp::patient {

ForceForesight::ForceForesight(const PatientDevices& devices,
                               double period,
                               const ForceForesightConfig& config) noexcept
    : config_{config},
      period_{period},
      hidden_{std::max(0.0, devices.sensor.lag - 1 / (2 * std::numbers::pi * devices.sensor.pole))},
      late_{devices.stage.lag + devices.sensor.lag +
            0.5 * (1 / devices.stage.rate + 1 / devices.sensor.rate)},
      share_{std::max(config.share_min, 1 - config.braking / std::max(devices.stage.lag, period))},
      touched_{felt_as_contact(devices.sensor)},
      doubt_{devices.sensor.step + 2 * devices.sensor.noise},
      tip_filter_{devices.sensor.pole, period} {}

void ForceForesight::begin(double tip) noexcept {
  tip_filter_.reset(tip);
  tips_.fill(tip);
  count_ = 0;
  stiffness_ = force_ = 0;
}

void ForceForesight::feel(double tip, double force, std::optional<double> age) noexcept {
  tips_[++ticks_ % tips_.size()] = tip_filter_.step(tip);
  if (!age) return;
  constexpr double kOldest = 127;
  const double late = std::clamp((*age + hidden_) / period_, 0.0, kOldest);
  const auto ticks_ago = static_cast<std::size_t>(std::lround(late));
  readings_[count_++ % readings_.size()] = {
      .tip = tips_[(ticks_ + tips_.size() - ticks_ago) % tips_.size()],
      .force = force,
      .at = static_cast<double>(ticks_) * period_};
  learn();
}

/// A slow sensor has few readings in any window: three, or two that lie far apart, will do.
void ForceForesight::learn() noexcept {
  const std::size_t held = std::min(count_, readings_.size());
  const Reading& newest = reading(0);
  double low = newest.tip;
  double high = newest.tip;
  std::size_t used = 0;
  for (; used < held; ++used) {
    const bool enough = used >= 3 || (used == 2 && high - low > 3 * config_.span);
    if (enough && newest.at - reading(used).at > config_.window) break;
    low = std::min(low, reading(used).tip);
    high = std::max(high, reading(used).tip);
  }
  fit(used, high - low >= config_.span);
}

/// A straight line through the newest `used` readings, by least squares; as steep as the one before
/// where the tip hardly moved.
void ForceForesight::fit(std::size_t used, bool moved) noexcept {
  const Reading& newest = reading(0);
  double way = 0;
  double rise = 0;
  double square = 0;
  double product = 0;
  for (std::size_t i = 0; i < used; ++i) {
    const double dx = reading(i).tip - newest.tip;
    const double df = reading(i).force - newest.force;
    way += dx;
    rise += df;
    square += dx * dx;
    product += dx * df;
  }
  const auto count = static_cast<double>(used);
  if (moved) {
    stiffness_ = std::max(0.0, (product - way * rise / count) / (square - way * way / count));
  }
  force_ = newest.force + (rise - stiffness_ * way) / count;
}

/// Below the limit, where the tip comes to rest [N].
double ForceForesight::rest(double limit) const noexcept {
  return limit - std::min(config_.margin, limit / 2);
}

double ForceForesight::step_most(double limit) const noexcept {
  if (count_ == 0) return std::numeric_limits<double>::max();
  const double missing = std::max(0.0, rest(limit) - std::max(force_, reading(0).force));
  const double way = missing / std::max(stiffness_, config_.stiffness_min);
  return way * period_ / late_;
}

double ForceForesight::bound(double tip, double limit) const noexcept {
  if (count_ == 0) return std::numeric_limits<double>::max();
  const Reading& newest = reading(0);
  // Where the force leaves the line, the tissue has a kink.
  const double force = std::max(force_, newest.force - doubt_);
  const double stiffness =
      newest.force >= touched_ ? std::max(stiffness_, config_.stiffness_min) : stiffness_;
  if (!(stiffness > 0)) return std::numeric_limits<double>::max();
  const double kink = limit + config_.beyond;
  const double ahead =
      std::min((rest(limit) - force) / stiffness, (kink - force) / (config_.steeper * stiffness));
  // Where its target stands, the tip goes on by a share of its lead.
  return tip + (newest.tip + ahead - tip) / share_;
}

}  // namespace palp::patient
