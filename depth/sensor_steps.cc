#include "depth/sensor_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/random.h"

namespace palp::depth {
namespace {

constexpr double kLeastDither = 0.2;  // of a step: below it single steps show, not their mean

double density(double z) noexcept {
  return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

/// By summing over the codes within reach.
SensorSteps::Reading reading(double force, double noise, double quantum) noexcept {
  const int reach = 1 + static_cast<int>(std::ceil(6 * noise / quantum));
  double mean = 0;
  double square = 0;
  double slope = 0;
  for (int code = -reach; code <= reach + 1; ++code) {
    const double low = ((code - 0.5) * quantum - force) / noise;
    const double high = ((code + 0.5) * quantum - force) / noise;
    const double share = normal_cdf(high) - normal_cdf(low);
    const double off = code * quantum - force;
    mean += share * off;
    square += share * off * off;
    slope += code * quantum * (density(low) - density(high)) / noise;
  }
  return {.offset = mean, .slope = slope, .variance = square - mean * mean};
}

}  // namespace

SensorSteps::SensorSteps(double noise, double quantum)
    : quantum_{noise < quantum / std::sqrt(12.0) / 2 ? 0 : quantum} {
  if (!(quantum_ > 0)) {
    table_.fill({.offset = 0, .slope = 1, .variance = noise * noise});
    return;
  }
  const double before = noise * noise - quantum * quantum / 12;
  const double dither = std::max(kLeastDither * quantum, std::sqrt(std::max(0.0, before)));
  for (std::size_t i = 0; i <= kPhases; ++i) {
    table_[i] = reading(quantum * static_cast<double>(i) / kPhases, dither, quantum);
  }
}

SensorSteps::Reading SensorSteps::at(double force) const noexcept {
  if (!(quantum_ > 0)) return table_.front();
  const double steps = force / quantum_;
  const double place = (steps - std::floor(steps)) * kPhases;
  const auto entry = std::min(static_cast<std::size_t>(place), kPhases - 1);
  const double share = place - static_cast<double>(entry);
  const Reading& low = table_[entry];
  const Reading& high = table_[entry + 1];
  return {.offset = low.offset + share * (high.offset - low.offset),
          .slope = low.slope + share * (high.slope - low.slope),
          .variance = low.variance + share * (high.variance - low.variance)};
}

}  // namespace palp::depth
