#include "depth/depth_distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::depth {
namespace {

constexpr std::size_t kEntries = 1000;
constexpr double kForgotten = 20;    // [-], logarithm of a mass below the largest
constexpr double kNarrowest = 1e-7;  // [-]
constexpr double kAbove = 0.01;      // [-], left out of an interval
constexpr double kBelow = 0.04;      // [-]
constexpr double kWindow = 0.25;     // [-], of the stddev: in which densities are compared
constexpr double kLikeliest = 0.9;   // [-], of the largest density: not told apart from it

}  // namespace

DepthDistribution::DepthDistribution(std::span<const DepthMass> masses, double low, double high)
    : from_{low}, to_{high} {
  double most = -std::numeric_limits<double>::infinity();
  for (const DepthMass& mass : masses) most = std::max(most, mass.log_mass);
  log_total_ = most;
  if (!std::isfinite(most)) return;
  double total = 0;
  double square = 0;
  double first = std::log(high);
  double last = std::log(low);
  for (const DepthMass& mass : masses) {
    if (mass.log_mass < most - kForgotten) continue;
    const double share = std::exp(mass.log_mass - most);
    const double depth = std::exp(mass.log_depth);
    const double spread = depth * mass.width;
    total += share;
    mean_ += share * depth;
    square += share * (depth * depth + spread * spread / 12);
    first = std::min(first, mass.log_depth - 0.5 * mass.width);
    last = std::max(last, mass.log_depth + 0.5 * mass.width);
  }
  log_total_ = most + std::log(total);
  mean_ /= total;
  stddev_ = std::sqrt(std::max(0.0, square / total - mean_ * mean_));
  first = std::clamp(first, std::log(low), std::log(high) - kNarrowest);
  last = std::clamp(last, first + kNarrowest, std::log(high));
  low_ = first;
  step_ = (last - first) / static_cast<double>(kEntries - 1);

  // The share above a depth rises along a ramp for each mass. A ramp is two changes of the slope,
  // and those are cheap: each is split between the two entries round it.
  std::vector<double> bends(kEntries + 1);
  const auto bend = [&](double at, double change) {
    const double place = std::clamp((at - first) / step_, 0.0, static_cast<double>(kEntries - 1));
    const auto entry = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(entry);
    bends[entry] += change * (1 - part);
    bends[entry + 1] += change * part;
  };
  for (const DepthMass& mass : masses) {
    if (mass.log_mass < most - kForgotten) continue;
    const double share = std::exp(mass.log_mass - most) / total;
    const double begin = std::clamp(mass.log_depth - 0.5 * mass.width, first, last);
    const double end = std::clamp(mass.log_depth + 0.5 * mass.width, first, last);
    const double width = std::max(end - begin, step_);
    bend(begin, share / width);
    bend(begin + width, -share / width);
  }
  cumulated_.reserve(kEntries);
  double slope = 0;
  double sum = 0;
  for (std::size_t i = 0; i < kEntries; ++i) {
    cumulated_.push_back(sum);
    slope += bends[i];
    sum += slope * step_;
  }
  for (double& value : cumulated_) value /= std::max(cumulated_.back(), kNarrowest);
}

double DepthDistribution::share_above(double depth) const noexcept {
  const double place = (std::log(depth) - low_) / step_;
  if (!(place > 0)) return 0;
  const auto entry = static_cast<std::size_t>(place);
  if (entry + 1 >= cumulated_.size()) return 1;
  const double part = place - static_cast<double>(entry);
  return cumulated_[entry] + part * (cumulated_[entry + 1] - cumulated_[entry]);
}

DepthDistribution::Interval DepthDistribution::interval() const noexcept {
  Interval out{quantile(kAbove), quantile(1 - kBelow)};
  const double window = std::min(kWindow * stddev_, to_ - from_);
  if (cumulated_.empty() || !(window > 0)) return out;
  double most = 0;
  double above = 0;
  for (double at = from_; at < to_;) {
    at += window;
    const double reached = share_above(at);
    most = std::max(most, reached - above);
    above = reached;
  }
  const double first = share_above(from_ + window);
  const double last = 1 - share_above(to_ - window);
  if (std::max(first, last) < kLikeliest * most) return out;
  return first > last ? Interval{from_, quantile(1 - kAbove - kBelow)}
                      : Interval{quantile(kAbove + kBelow), to_};
}

double DepthDistribution::quantile(double share) const noexcept {
  if (cumulated_.empty()) return 0;
  const auto above = std::lower_bound(cumulated_.begin(), cumulated_.end(), share);
  if (above == cumulated_.begin()) return std::exp(low_);
  if (above == cumulated_.end()) return std::exp(low_ + step_ * (kEntries - 1));
  const double part = (share - *(above - 1)) / (*above - *(above - 1));
  const double entry = static_cast<double>(above - cumulated_.begin()) - 1 + part;
  return std::exp(low_ + step_ * entry);
}

}  // namespace palp::depth
