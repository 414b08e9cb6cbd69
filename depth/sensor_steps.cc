#include "depth/sensor_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "common/core/random.h"

namespace palp::depth {
namespace {

constexpr double kLeastDither = 0.2;  // of a step: below it single steps show, not their mean
constexpr double kNoSteps = 0.25;     // of the squares that the least dither makes
constexpr int kHalvings = 12;         // to 1/5000 of a step

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

/// Where in its step a force is [-], 0 to 1.
double phase_of(double force, double quantum) noexcept {
  const double steps = force / quantum;
  return steps - std::floor(steps);
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
  const double place = phase_of(force, quantum_) * kPhases;
  const auto entry = std::min(static_cast<std::size_t>(place), kPhases - 1);
  const double share = place - static_cast<double>(entry);
  const Reading& low = table_[entry];
  const Reading& high = table_[entry + 1];
  return {.offset = low.offset + share * (high.offset - low.offset),
          .slope = low.slope + share * (high.slope - low.slope),
          .variance = low.variance + share * (high.variance - low.variance)};
}

void NoiseInSteps::add(double force, double error, double quantum) noexcept {
  const double place = quantum > 0 ? phase_of(force, quantum) * kBins : 0;
  const auto bin = std::min(static_cast<std::size_t>(place), kBins - 1);
  squares_[bin] += error * error;
  counts_[bin] += 1;
}

void NoiseInSteps::add(const NoiseInSteps& other) noexcept {
  for (std::size_t i = 0; i < kBins; ++i) {
    squares_[i] += other.squares_[i];
    counts_[i] += other.counts_[i];
  }
}

bool NoiseInSteps::empty() const noexcept {
  return std::accumulate(counts_.begin(), counts_.end(), 0.0) == 0;
}

double NoiseInSteps::expected(double dither, double quantum) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (counts_[i] == 0) continue;
    const double force = (static_cast<double>(i) + 0.5) / kBins * quantum;
    const SensorSteps::Reading one = reading(force, dither, quantum);
    sum += counts_[i] * (one.variance + one.offset * one.offset);
  }
  return sum;
}

/// The dither whose expected squares are those that were seen: they grow with it.
double NoiseInSteps::rms(double quantum) const noexcept {
  const double count = std::accumulate(counts_.begin(), counts_.end(), 0.0);
  const double squares = std::accumulate(squares_.begin(), squares_.end(), 0.0);
  const double plain = std::sqrt(squares / std::max(count, 1.0));
  const double from_steps = quantum / std::sqrt(12.0);
  if (!(quantum > 0) || plain > std::hypot(quantum, from_steps)) return plain;
  double low = kLeastDither * quantum;
  if (squares < kNoSteps * expected(low, quantum)) return plain;
  double high = quantum;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (expected(middle, quantum) < squares ? low : high) = middle;
  }
  return std::hypot(0.5 * (low + high), from_steps);
}

}  // namespace palp::depth
