#include "common/coupling/spline_estimator.h"

#include <algorithm>
#include <cmath>

#include "common/coupling/nonnegative.h"

namespace palp::coupling {
namespace {

constexpr double kHatMin = 1e-3;  // [-], less of a node is nothing
/// [-], of the mean stiffness: how far a tissue is expected to be off its smooth shapes.
constexpr double kKnotSpread = 0.7;
/// [-], likewise: by how much that changes from knot to knot. Deeper than anything was touched it
/// stays as it was last.
constexpr double kKnotChange = 0.2;
constexpr double kStiffnessLeast = 10;  // [N/m], mean
constexpr double kDepthLeast = 1e-3;    // [m], over which a mean is one
constexpr double kDepthNone = 1e-9;     // [m], where the slope at the surface is taken
// Improvements of a sum of squares, in variances: chance alone makes one for each knot.
constexpr double kWorthFrom = 20;
constexpr double kWorthAll = 40;

}  // namespace

void SplineEstimator::begin(double lowest, double position) noexcept {
  *this = {};
  lowest_ = lowest;
  follow(position, 1);
  begin_equation();
}

void SplineEstimator::expect(const KnotStiffness& stiffness, double share) noexcept {
  stiffness_ = expected_ = stiffness;
  share_ = expected_share_ = share;
}

void SplineEstimator::follow(double position, double gain) noexcept {
  for (double& hat : hats_) hat -= gain * hat;
  const double at = std::min((position - lowest_) / kNodeStep, static_cast<double>(kNodes - 1));
  if (at > 0) {
    const auto node = std::min(static_cast<std::size_t>(at), kNodes - 2);
    const double share = at - static_cast<double>(node);
    hats_[node] += gain * (1 - share);
    hats_[node + 1] += gain * share;
  }
  for (std::size_t i = 0; i < kNodes; ++i) passed_[i] += hats_[i];
  count_ += 1;
}

void SplineEstimator::begin_equation() noexcept {
  passed_ = {};
  count_ = 0;
}

void SplineEstimator::add(const Met& met, double weight, double keep) noexcept {
  const double scale = 1 / std::max(1.0, count_);
  for (double& hat : passed_) hat *= scale;
  for (std::size_t i = 0; i < kNodes; ++i) {
    for (std::size_t part = 0; part < met.size(); ++part) {
      right_[part][i] = keep * right_[part][i] + weight * met[part] * passed_[i];
    }
    for (double& product : normal_[i]) product *= keep;
    if (passed_[i] < kHatMin) continue;
    for (std::size_t j = 0; j < kNodes; ++j) normal_[i][j] += weight * passed_[i] * passed_[j];
  }
}

/// [N^2], what `force` [N] at the nodes leaves, but for a constant.
double SplineEstimator::cost_of(const Nodes& force, const Nodes& right) const noexcept {
  double cost = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (force[i] == 0) continue;
    double row = 0;
    for (std::size_t j = 0; j < kNodes; ++j) row += normal_[i][j] * force[j];
    cost += force[i] * (row - 2 * right[i]);
  }
  return cost;
}

/// [N] at the nodes, less what is not elastic in it.
SplineEstimator::Nodes SplineEstimator::elastic(const Factors& factors) const noexcept {
  Nodes right = right_[0];
  for (std::size_t k = 0; k < kBeside; ++k) {
    for (std::size_t i = 0; i < kNodes; ++i) right[i] -= factors[k] * right_[1 + k][i];
  }
  return right;
}

SplineEstimator::Ramps SplineEstimator::ramps_under(double surface) const noexcept {
  Ramps ramps{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double depth = depth_of(i, surface);
    if (depth <= 0) continue;
    for (std::size_t k = 0; k < kKnots; ++k) ramps[k][i] = knot_ramp(k, depth);
  }
  return ramps;
}

SmallSystem<SplineEstimator::kKnots> SplineEstimator::equations(const Ramps& ramps,
                                                                const Nodes& right) const noexcept {
  SmallSystem<kKnots> system;
  for (std::size_t k = 0; k < kKnots; ++k) {
    Nodes through{};
    for (std::size_t i = 0; i < kNodes; ++i) {
      if (ramps[k][i] == 0) continue;
      for (std::size_t j = 0; j < kNodes; ++j) through[j] += normal_[i][j] * ramps[k][i];
      system.right[k] += ramps[k][i] * right[i];
    }
    for (std::size_t other = 0; other < kKnots; ++other) {
      for (std::size_t j = 0; j < kNodes; ++j) {
        system.matrix[other][k] += through[j] * ramps[other][j];
      }
    }
  }
  return system;
}

double SplineEstimator::fit(const ContactModel& smooth,
                            const Factors& factors,
                            double noise) noexcept {
  const Nodes right = elastic(factors);
  const Ramps ramps = ramps_under(smooth.surface);
  SmallSystem<kKnots> system = equations(ramps, right);
  const double mean =
      std::max(kStiffnessLeast, smooth.force(smooth.reach) / std::max(kDepthLeast, smooth.reach));
  KnotStiffness spread;
  spread.fill(kKnotSpread * mean);
  KnotStiffness prior{};  // [N/m]
  for (std::size_t k = 0; k < kKnots; ++k) {
    const double slope = smooth.slope(std::max(kDepthNone, kModelKnots[k] * kModelDepthScale));
    prior[k] = slope + expected_share_ * (expected_[k] - slope);
    const double weight = noise / (spread[k] * spread[k]);
    system.matrix[k][k] += weight;
    system.right[k] += weight * prior[k];
    if (k == 0) continue;
    const double change = noise / (kKnotChange * mean * kKnotChange * mean);
    const double step = prior[k] - prior[k - 1];
    system.matrix[k][k] += change;
    system.matrix[k - 1][k - 1] += change;
    system.matrix[k][k - 1] -= change;
    system.matrix[k - 1][k] -= change;
    system.right[k] += change * step;
    system.right[k - 1] -= change * step;
  }
  stiffness_ = prior;
  Nonnegative{system, spread}.improve(stiffness_);

  Nodes expected{};  // [N]
  Nodes found{};     // [N]
  for (std::size_t i = 0; i < kNodes; ++i) {
    expected[i] = smooth.force(depth_of(i, smooth.surface));
    for (std::size_t k = 0; k < kKnots; ++k) found[i] += stiffness_[k] * ramps[k][i];
  }
  const double better = cost_of(expected, right) - cost_of(found, right);
  const double worth =
      std::clamp((better / noise - kWorthFrom) / (kWorthAll - kWorthFrom), 0.0, 1.0);
  share_ = std::max(expected_share_, worth);
  return better;
}

}  // namespace palp::coupling
