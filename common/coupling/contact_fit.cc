/// The least squares of the contact estimator.

#include <algorithm>
#include <cmath>

#include "common/coupling/contact_estimator.h"

namespace palp::coupling {
namespace {

constexpr double kClosed = 1e-3;  // [-], of the spread of what is not open to the data
// Spread of the prior, in the order of the terms: the shapes in [N], of the orders of a 5 mm ball
// on tissue of tens of kPa with an inclusion 5 mm deep, wide against what one tap tells; the shares
// that relax [-]; the damping [s/m]. The linear shape is held closer: a little of it and a surface
// a little higher look alike.
constexpr std::array<double, kModelTerms + kModelTimes.size() + 1> kSpread{
    0.02, 0.03, 0.02, 0.004, 1e-4, 0.02, 0.02, 1};

/// Index of (row, column >= row) of a symmetric matrix kept by rows.
constexpr std::size_t pair(std::size_t terms, std::size_t row, std::size_t column) noexcept {
  if (row > column) std::swap(row, column);
  return row * terms - row * (row + 1) / 2 + column;
}

}  // namespace

/// Coefficients >= 0 of least cost: an active set that starts from the last solution and grows or
/// shrinks by one term at a time (Lawson and Hanson, NNLS), at most 16 times.
ContactEstimator::Solution ContactEstimator::solve(std::size_t candidate) noexcept {
  const double noise = equation_noise();
  std::array<std::array<double, kTerms>, kTerms> a{};
  Terms b{};
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

  Terms c = found_[candidate];
  std::array<bool, kTerms> used{};
  for (std::size_t row = 0; row < kTerms; ++row) used[row] = c[row] > 0;
  for (int round = 0; round < 16; ++round) {
    // Least squares over the terms in use: elimination in place.
    std::array<std::size_t, kTerms> map{};
    std::size_t count = 0;
    for (std::size_t row = 0; row < kTerms; ++row) {
      if (used[row]) map[count++] = row;
    }
    std::array<std::array<double, kTerms>, kTerms> m{};
    Terms y{};
    for (std::size_t r = 0; r < count; ++r) {
      y[r] = b[map[r]];
      for (std::size_t s = 0; s < count; ++s) m[r][s] = a[map[r]][map[s]];
    }
    for (std::size_t r = 0; r < count; ++r) {
      const double inverse = 1 / m[r][r];
      for (std::size_t below = r + 1; below < count; ++below) {
        const double factor = m[below][r] * inverse;
        for (std::size_t s = r; s < count; ++s) m[below][s] -= factor * m[r][s];
        y[below] -= factor * y[r];
      }
    }
    for (std::size_t r = count; r-- > 0;) {
      for (std::size_t s = r + 1; s < count; ++s) y[r] -= m[r][s] * y[s];
      y[r] /= m[r][r];
    }
    // A negative one leaves; as far as the way there allows.
    double way = 1;
    std::size_t leaves = kTerms;
    for (std::size_t r = 0; r < count; ++r) {
      if (y[r] > 0) continue;
      const double from = c[map[r]];
      const double share = from > 0 ? from / (from - y[r]) : 0;
      if (share <= way) {
        way = share;
        leaves = map[r];
      }
    }
    for (std::size_t r = 0; r < count; ++r) c[map[r]] += way * (y[r] - c[map[r]]);
    if (leaves < kTerms) {
      c[leaves] = 0;
      used[leaves] = false;
      continue;
    }
    // One that would help joins.
    double steepest = 1e-12;
    std::size_t joins = kTerms;
    for (std::size_t row = 0; row < kTerms; ++row) {
      if (used[row]) continue;
      double gain = b[row];
      for (std::size_t column = 0; column < kTerms; ++column) gain -= a[row][column] * c[column];
      const double relative = gain * kSpread[row];
      if (relative > steepest) {
        steepest = relative;
        joins = row;
      }
    }
    if (joins == kTerms) break;
    used[joins] = true;
  }

  found_[candidate] = c;
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
