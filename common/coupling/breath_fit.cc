#include "common/coupling/breath_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/coupling/contact_model.h"
#include "common/coupling/nonnegative.h"

namespace palp::coupling {
namespace {

// An adult at rest breathes 12 to 20 times a minute; a short arc fits many paces.
constexpr double kUsual = 2 * std::numbers::pi * 0.26;  // [rad/s]
constexpr double kUnusual = 8;                          // [-], cost of an octave
// What a sample may be off by: in the fit, and where it is judged how much a breath explains. By
// the second in the fit the tissue would be found too soft.
constexpr double kNoise = 15e-3;      // [N], with what no such tissue explains,
constexpr double kFitShare = 0.02;    // [-], and of the force
constexpr double kJudgeShare = 0.05;  // [-], the same
constexpr double kTouches = 0.03;     // [N], of less force nothing says what relaxes
constexpr double kSlopeLeast = 5e-3;  // [N/mm], of a less steep tissue a force says no height
constexpr double kDepthFirst = 0.3;   // [mm], at least, where a depth is sought from
constexpr double kDepthMost = 4;      // [mm], at the first touch
constexpr int kLooks = 8;             // for a depth
constexpr double kNear = 1e-3;        // [mm], then it is found
constexpr double kDamped = 0.5;       // [-], of Marquardt
constexpr double kStepMost = 0.5;     // [mm], of the surface: the equations hold no farther
constexpr double kAbove = 100;        // [mm], so that any surface is above 0
constexpr double kRateKnown = 100;    // [s^2/rad^2], inverse covariance of a pace
// So closely are places alike: by this share of what tissues differ by, and all of it far away.
constexpr double kLikeLast = 0.5;  // [-], of the last one's shapes, or by kSpreadFirst
constexpr double kAlike = 0.1;     // [-]
constexpr double kUnlike = 10e-3;  // [m]
constexpr BreathTissue kFirst{0.06, 0, 0, 0, 0, 0, 0};
constexpr BreathTissue kSpreadFirst{0.1, 0.05, 0.02, 3, 0.2, 0.2, 1};

/// Force [N] and slope [N/mm] of the shapes at a depth, and the shapes themselves [-].
struct Elastic {
  double force{};
  double slope{};
  std::array<double, kBreathShapes> shape{};
};
Elastic elastic(const BreathTissue& tissue, double depth) noexcept {
  const double xi = std::max(0.0, depth);
  const double bend = 1 + xi / kModelBend;
  const double root = std::sqrt(xi / bend);
  const std::array<double, kBreathShapes> slope{
      root * (1.5 - 0.5 * xi / (kModelBend * bend)), 2 * xi, 3 * xi * xi};
  Elastic there{.shape = {xi * root, xi * xi, xi * xi * xi}};
  for (std::size_t j = 0; j < kBreathShapes; ++j) {
    there.force += tissue[j] * there.shape[j];
    there.slope += tissue[j] * slope[j];
  }
  return there;
}

constexpr double squared(double x) noexcept { return x * x; }

using Square = std::array<BreathTissue, kBreathUnknowns>;
/// Of what concerns the tissue; 0 where that is not regular, and in the row of the pace.
Square inverse(const Square& square) noexcept {
  Square inverted{};
  std::array<bool, kBreathUnknowns> open{};
  std::fill_n(open.begin(), kBreathRate, true);
  for (std::size_t i = 0; i < kBreathRate; ++i) {
    SmallSystem<kBreathUnknowns> column{square, {}};
    column.right[i] = 1;
    inverted[i] = solve(column, open).x;
  }
  return inverted;
}

}  // namespace

BreathPrior first_breath_prior() noexcept {
  BreathPrior prior{kFirst, {}};
  for (std::size_t i = 0; i < kBreathRate; ++i) prior.closely[i][i] = 1 / squared(kSpreadFirst[i]);
  return prior;
}

BreathPrior prior_beside(const BreathPrior& found, double distance) noexcept {
  const double nearness = std::min(1.0, kAlike + distance / kUnlike);
  BreathPrior prior{found.tissue, inverse(found.closely)};
  for (std::size_t i = 0; i < kBreathRate; ++i) {
    const double like = i < kBreathShapes ? kLikeLast * found.tissue[i] : 0;
    prior.closely[i][i] += squared(nearness * std::max(kSpreadFirst[i], like));
  }
  prior.closely = inverse(prior.closely);
  return prior;
}

BreathFit::BreathFit(double rate, double band) noexcept : path_{rate}, rate_{rate}, band_{band} {
  here_[kBreathRate] = rate;
}

void BreathFit::suppose(const BreathTissue& tissue) noexcept {
  const double rate = here_[kBreathRate];
  here_ = tissue;
  here_[kBreathRate] = rate;
}

void BreathFit::seek(double position, double force, double displacement) noexcept {
  double depth = kDepthFirst;
  for (int look = 0; look < kLooks; ++look) {
    const Elastic there = elastic(here_, depth);
    depth += (std::max(0.0, force) - there.force) / std::max(kSlopeLeast, there.slope);
    depth = std::clamp(depth, 0.0, kDepthMost);
  }
  here_[kBreathSurface] = (position - displacement) / kModelDepthScale - depth;
}

BreathPrior BreathFit::found() const noexcept {
  BreathPrior found{here_, known_};
  found.closely[kBreathRate] = {};
  for (BreathTissue& row : found.closely) row[kBreathRate] = 0;
  return found;
}

/// In first order about where the surface must be by the path and by the force, with the tissue as
/// it is supposed. None: the sample says nothing of it.
std::optional<BreathFit::Sight> BreathFit::sight(const BreathTissue& tissue,
                                                 const Path& path,
                                                 const BreathSample& sample) noexcept {
  const double tip = sample.position / kModelDepthScale - tissue[kBreathSurface];
  // Tissue does not pull: of one that is hardly touched nothing says what it would.
  const bool lets_go = sample.force >= kTouches;
  double force = sample.force;
  for (std::size_t k = 0; lets_go && k < sample.past.size(); ++k) {
    force += tissue[kBreathRelaxes + k] * sample.past[k];
  }
  const double noise = squared(kNoise) + squared(kFitShare * sample.force);
  const double foreseen = tip - path.displacement();
  double depth = std::max(foreseen, kDepthFirst);
  for (int look = 0; look < kLooks; ++look) {
    const Elastic there = elastic(tissue, depth);
    const double slope = std::max(kSlopeLeast, there.slope);
    const double gain = path.variance() / (path.variance() + noise / squared(slope));
    const double next = foreseen + gain * (depth + (force - there.force) / slope - foreseen);
    const double way = next - depth;
    depth = std::max(next, 0.2 * depth);
    if (std::abs(way) < kNear) break;
  }
  const Elastic there = elastic(tissue, depth);
  if (there.slope < kSlopeLeast) return {};
  Sight seen{.displacement = tip - depth - (force - there.force) / there.slope,
             .variance = noise / squared(there.slope),
             .slope = there.slope};
  for (std::size_t j = 0; j < kBreathShapes; ++j) seen.by[j] = there.shape[j] / there.slope;
  seen.by[kBreathSurface] = -1;
  for (std::size_t k = 0; lets_go && k < sample.past.size(); ++k) {
    seen.by[kBreathRelaxes + k] = -sample.past[k] / there.slope;
  }
  return seen;
}

void BreathFit::add(const BreathSample& sample, bool here) noexcept {
  if (!pass_.path) {
    pass_.path = rate_ > 0 ? Path{here_[kBreathRate]} : Path{};
  } else if (rate_ > 0) {
    pass_.path->pass(sample.at - pass_.at);
  }
  pass_.at = sample.at;
  pass_.count += 1;
  const double weight = 1 / (1 + squared(kJudgeShare * sample.force / kNoise));
  std::optional<Sight> seen = sight(here ? here_ : before_, *pass_.path, sample);
  if (!seen) {
    pass_.square += weight * squared(sample.force);
    pass_.cost += squared(sample.force / kNoise);
    return;
  }
  if (!here) seen->by = {};
  const Path::Innovation found = pass_.path->see(seen->displacement, seen->variance, seen->by);
  pass_.square += weight * squared(found.left * seen->slope);
  pass_.cost += squared(found.left) / found.variance;
  pass_.away += squared(pass_.path->displacement());
  for (std::size_t i = 0; i < kBreathUnknowns; ++i) {
    pass_.system.right[i] -= found.by[i] * found.left / found.variance;
    for (std::size_t j = 0; j < kBreathUnknowns; ++j) {
      pass_.system.matrix[i][j] += found.by[i] * found.by[j] / found.variance;
    }
  }
}

void BreathFit::expect(const BreathPrior& prior) noexcept {
  for (std::size_t i = 0; i < kBreathUnknowns; ++i) {
    const double off_i = here_[i] - prior.tissue[i];
    for (std::size_t j = 0; j < kBreathUnknowns; ++j) {
      const double pull = prior.closely[i][j] * (here_[j] - prior.tissue[j]);
      pass_.system.matrix[i][j] += prior.closely[i][j];
      pass_.system.right[i] -= pull;
      pass_.cost += off_i * pull;
    }
  }
  pass_.system.matrix[kBreathRate][kBreathRate] += kRateKnown;
  if (rate_ > 0) pass_.cost += kUnusual * squared(std::log2(here_[kBreathRate] / kUsual));
}

/// The best change of the tissue by which none of it becomes negative.
BreathTissue BreathFit::step() const noexcept {
  SmallSystem<kBreathUnknowns> system = pass_.system;
  BreathTissue from = here_;
  from[kBreathSurface] = kAbove;
  for (std::size_t i = 0; i < kBreathUnknowns; ++i) {
    system.matrix[i][i] *= 1 + kDamped;
    for (std::size_t j = 0; j < kBreathUnknowns; ++j) {
      system.right[i] += system.matrix[i][j] * from[j];
    }
  }
  BreathTissue to = from;
  Nonnegative<kBreathUnknowns>{system, kSpreadFirst}.improve(to);
  const double most = std::abs(to[kBreathSurface] - kAbove);
  const double share = most > kStepMost ? kStepMost / most : 1;
  for (std::size_t i = 0; i < kBreathUnknowns; ++i) to[i] = share * (to[i] - from[i]);
  return to;
}

void BreathFit::improve(const BreathPrior& prior) noexcept {
  if (!pass_.path) return;
  expect(prior);
  BreathTissue change = step();
  const double rate = here_[kBreathRate] + change[kBreathRate];
  change[kBreathRate] =
      std::clamp(rate, rate_ / (1 + band_), rate_ * (1 + band_)) - here_[kBreathRate];
  for (std::size_t i = 0; i < kBreathUnknowns; ++i) here_[i] += change[i];
  path_ = *pass_.path;
  path_.change(change);
  seen_at_ = pass_.at;
  known_ = pass_.system.matrix;
  cost_ = pass_.cost;
  square_ = pass_.square / pass_.count;
  amplitude_ = kModelDepthScale * std::sqrt(2 * pass_.away / pass_.count);
}

void BreathFit::follow(const BreathSample& sample) noexcept {
  path_ = at(sample.at);
  seen_at_ = sample.at;
  if (const std::optional<Sight> seen = sight(here_, path_, sample)) {
    path_.see(seen->displacement, seen->variance, {});
  }
}

BreathFit::Path BreathFit::at(double time) const noexcept {
  Path path = path_;
  path.pass(time - seen_at_);
  return path;
}

}  // namespace palp::coupling
