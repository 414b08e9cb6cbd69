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

constexpr double kRestWeight = 40;   // [-], of equations: fewer fit any tissue
constexpr double kRestNoise = 1.6;   // [-], of their noise, and
constexpr double kRestShare = 0.04;  // [-], of the force: what a tissue may leave

}  // namespace

ContactEstimator::Solution ContactEstimator::solve(std::size_t candidate, bool relaxes) noexcept {
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
    const bool closed = !relaxes && row >= kModelTerms && row + 1 < kTerms;
    const double spread = expected_.doubt * kSpread[row] * (closed ? kClosed : 1);
    const double prior = noise / (spread * spread);
    a[row][row] += prior;
    b[row] = right_[row][candidate] + (closed ? 0 : prior * expected_.c[row]);
  }

  Terms& c = found_[candidate];
  Nonnegative{system, kSpread}.improve(c);
  double cost = sums_.square;
  for (std::size_t row = 0; row < kTerms; ++row) {
    double product = 0;
    for (std::size_t column = 0; column < kTerms; ++column) product += a[row][column] * c[column];
    cost += c[row] * (product - 2 * b[row]);
    const double expected = expected_.c[row] / (expected_.doubt * kSpread[row]);
    cost += noise * expected * expected;
  }
  const double spread = config_.surface_spread * std::sqrt(expected_.doubt);
  const double off = (surface_of(candidate) - expected_.surface) / spread;
  return {c, cost + noise * off * off};
}

/// Whether `left` [N^2], of the sum of squares, is no more than noise and a share of the force.
bool ContactEstimator::explains(double left) const noexcept {
  const double noise = kRestNoise * kRestNoise * equation_noise();
  return left <= sums_.weight * noise + kRestShare * kRestShare * sums_.square;
}

/// @returns what the spline leaves unexplained beside the smooth shapes of `solution` [N^2].
double ContactEstimator::fit_spline_beside(const Solution& solution) noexcept {
  ContactModel smooth{.surface = surface_of(best_)};
  std::copy_n(solution.c.begin(), kModelTerms, smooth.c.begin());
  smooth.reach = std::max(0.0, here_.deepest - smooth.surface) + kModelReachBeyond;
  SplineEstimator::Factors beside{};
  std::copy(solution.c.begin() + kModelTerms, solution.c.end(), beside.begin());
  const double noise = equation_noise();
  return solution.cost - spline_.fit(smooth, beside, noise);
}

/// Where the surface breathes, and where it may, heights say nothing of depths. A breath fits what
/// softens, has kinks or relaxes; so it is asked first whether a tissue at rest that does all this
/// explains what was felt. `told`: the smooth shapes as they are told.
void ContactEstimator::fit_spline(const Solution& told) noexcept {
  if (swing_.believed()) return spline_.drop();
  Solution rest = told;
  if (!swing_.still()) {
    const Terms before = found_[best_];
    rest = solve(best_, true);
    found_[best_] = before;
  }
  const double left = fit_spline_beside(rest);
  const bool explained = explains(left);
  if (sums_.weight >= kRestWeight) swing_.rest(left / sums_.weight, explained);
  if (!swing_.settled()) return spline_.drop();
  if (!explained && !swing_.still()) fit_spline_beside(told);
}

}  // namespace palp::coupling
