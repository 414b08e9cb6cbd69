#include "lab/plan/stiffness_process.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace palp::lab {
namespace {

constexpr double kFieldStep = 2e-3;                                             // [m]
constexpr std::array kLengths{4e-3, 5e-3, 6e-3, 7.5e-3, 9.5e-3, 12e-3, 15e-3};  // [m]
constexpr std::array kSpreads{0.02, 0.03, 0.05, 0.08, 0.12, 0.18, 0.3};         // [-]
constexpr std::array kOwns{0.003, 0.01, 0.025, 0.05};                           // [-]

}  // namespace

StiffnessReading stiffness_reading(const depth::PlaceData& place) noexcept {
  depth::NodalCurve plain{};
  plain.fill(1);
  const depth::FactorTold told = depth::factor_told(place, plain, 0);
  // A force of nothing or less is noise.
  const double ratio = std::max(told.pull / told.information, 0.1);
  return {.place = place.place,
          .value = std::log(ratio),
          .stddev = 1 / (ratio * std::sqrt(told.information))};
}

StiffnessProcess::StiffnessProcess(std::vector<StiffnessReading> readings, const Kernel& kernel)
    : readings_{std::move(readings)}, kernel_{kernel} {
  const std::size_t count = readings_.size();
  root_.resize(count * count);
  log_evidence_ = -0.5 * static_cast<double>(count) * std::log(2 * std::numbers::pi);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = covariance(readings_[i].place, readings_[j].place);
      if (i == j) sum += kernel.own * kernel.own + readings_[i].stddev * readings_[i].stddev;
      for (std::size_t k = 0; k < j; ++k) sum -= root_[i * count + k] * root_[j * count + k];
      root_[i * count + j] = i == j ? std::sqrt(std::max(sum, 1e-18)) : sum / root_[j * count + j];
    }
    log_evidence_ -= std::log(root_[i * count + i]);
    solved_.push_back(readings_[i].value - kernel.mean);
  }
  forward(solved_);
  for (const double one : solved_) log_evidence_ -= 0.5 * one * one;
}

StiffnessProcess StiffnessProcess::fitted(const std::vector<StiffnessReading>& readings) {
  std::optional<StiffnessProcess> best;
  for (const double length : kLengths) {
    for (const double spread : kSpreads) {
      for (const double own : kOwns) {
        StiffnessProcess one{readings, {.length = length, .spread = spread, .own = own}};
        if (!best || one.log_evidence() > best->log_evidence()) best = std::move(one);
      }
    }
  }
  return *std::move(best);
}

double StiffnessProcess::covariance(const Place& a, const Place& b) const noexcept {
  const double apart = distance(a, b) / kernel_.length;
  return kernel_.mean_stddev * kernel_.mean_stddev +
         kernel_.spread * kernel_.spread * std::exp(-0.5 * apart * apart);
}

void StiffnessProcess::forward(std::vector<double>& right) const noexcept {
  const std::size_t count = right.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k) right[i] -= root_[i * count + k] * right[k];
    right[i] /= root_[i * count + i];
  }
}

StiffnessTold StiffnessProcess::at(const Place& place) const {
  std::vector<double> shared;
  shared.reserve(readings_.size());
  for (const StiffnessReading& one : readings_) shared.push_back(covariance(one.place, place));
  forward(shared);
  StiffnessTold out{.mean = kernel_.mean};
  double variance = covariance(place, place);
  for (std::size_t i = 0; i < shared.size(); ++i) {
    out.mean += shared[i] * solved_[i];
    variance -= shared[i] * shared[i];
  }
  out.stddev = std::sqrt(std::max(0.0, variance));
  return out;
}

Place stiffest_place(const StiffnessProcess& process, double half, double trust) {
  Place best;
  double most = -std::numeric_limits<double>::infinity();
  const int steps = static_cast<int>(std::floor(half / kFieldStep + 1e-9));
  for (int i = -steps; i <= steps; ++i) {
    for (int k = -steps; k <= steps; ++k) {
      const Place place{i * kFieldStep, k * kFieldStep};
      const StiffnessTold told = process.at(place);
      const double bound = told.mean + trust * told.stddev;
      if (bound <= most) continue;
      most = bound;
      best = place;
    }
  }
  return best;
}

}  // namespace palp::lab
