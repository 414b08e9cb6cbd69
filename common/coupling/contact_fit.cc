/// The least squares of the contact estimator.

#include <algorithm>
#include <cmath>

#include "common/core/small_solver.h"
#include "common/coupling/contact_estimator.h"
#include "common/coupling/nonnegative.h"

namespace palp::coupling {
namespace {

constexpr std::size_t kTerms = kModelTerms + kModelTimes.size() + 1;
using Terms = std::array<double, kTerms>;

constexpr double kClosed = 1e-3;  // [-], of the spread of what is not open to the data
// Spread of the prior, in the order of the terms: the shapes in [N], of the orders of a 5 mm ball
// on tissue of tens of kPa with an inclusion 5 mm deep, wide against what one tap tells; the shares
// that relax [-]; the damping [s/m]. The linear shape is held closer: a little of it and a surface
// a little higher look alike.
constexpr Terms kSpread{0.02, 0.03, 0.02, 0.004, 1e-4, 0.02, 0.02, 1};

/// Index of (row, column >= row) of a symmetric matrix kept by rows.
constexpr std::size_t pair(std::size_t terms, std::size_t row, std::size_t column) noexcept {
  if (row > column) std::swap(row, column);
  return row * terms - row * (row + 1) / 2 + column;
}

}  // namespace

ContactEstimator::Solution ContactEstimator::solve(std::size_t candidate) noexcept {
  const double noise = equation_noise();
  SmallSystem<kTerms> system;
  auto& a = system.matrix;
  Terms& b = system.right;
  for (std::size_t row = 0; row < kTerms; ++row) {
    for (std::size_t column = 0; column < kTerms; ++column) {
      a[row][column] = normal_[pair(kTerms, row, column)][candidate];
    }
    // What relaxes and what swings with a breath look alike: until the surface is known to stand
    // still nothing relaxes.
    const bool closed = !swing_.still() && row >= kModelTerms && row + 1 < kTerms;
    const double spread = closed ? kClosed * kSpread[row] : kSpread[row];
    const double prior = noise / (spread * spread);
    a[row][row] += prior;
    b[row] = right_[row][candidate] + (closed ? 0 : prior * expected_[row]);
  }

  Terms& c = found_[candidate];
  Nonnegative{system, kSpread}.improve(c);
  double cost = square_;
  for (std::size_t row = 0; row < kTerms; ++row) {
    double product = 0;
    for (std::size_t column = 0; column < kTerms; ++column) product += a[row][column] * c[column];
    cost += c[row] * (product - 2 * b[row]);
    cost += noise * (expected_[row] / kSpread[row]) * (expected_[row] / kSpread[row]);
  }
  const double off = (surface_of(candidate) - surface_expected_) / config_.surface_spread;
  return {c, cost + noise * off * off};
}

}  // namespace palp::coupling
