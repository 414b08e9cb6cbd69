#include "patient_site/estimator/depth_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "patient_site/estimator/peak_search.h"

namespace palp::estimator {
namespace {

constexpr std::size_t kRadiusCells = 6;  // to begin with
constexpr std::size_t kRatioCells = 4;
constexpr std::size_t kLinesMax = 300;  // a bound on the time
constexpr std::array kDoublings{0, 3};  // of the way from a guess to a line's best: most are near
constexpr double kReach = 4;            // [-], standard deviations below the best: forgotten
constexpr double kFine = 0.9;           // [-], standard deviations to a cell's edge: fine enough
constexpr double kCaution = 1.4;        // [-], the information changes within a cell
constexpr double kNegligible = 10;      // [-], log-likelihood below a line's best: its ends
constexpr std::size_t kMany = 60;       // cells, of which those narrower in the depth than
constexpr double kNarrow = 0.03;        // [-] need not be summed: the posterior is made of many
constexpr double kNormalReach = 3.5;    // [-], standard deviations
constexpr int kNormalParts = 7;
constexpr std::size_t kDepths = 21;        // of one line, summed
constexpr double kShift = 0.3;             // [-], of the posterior's width, within a cell
constexpr int kPasses = 2;                 // from cells to the posterior's width and back
constexpr std::size_t kShowingStride = 4;  // of the radii
constexpr double kExcluded = 3;            // [-], log of 20

DepthPrior showing(const fem::DepthDatabase& database, const DepthPrior& prior) {
  return {.depth_min = database.grid().depths.front(),
          .depth_max = database.grid().depths.back(),
          .radius_min = kShowingRadius,
          .radius_max = database.grid().radii.back(),
          .ratio_min = kShowingRatio,
          .ratio_max = kShowingRatio,
          .shape = prior.shape};
}

}  // namespace

DepthModel::DepthModel(const fem::DepthDatabase& database, const DepthPrior& prior)
    : prior_{prior},
      height_{database.grid().block.height},
      lattice_{database, prior},
      showing_{database, showing(database, prior)},
      basis_{database} {}

/// An inclusion does not reach below the block.
double DepthModel::deepest(double radius) const noexcept {
  const double lowest = std::log(prior_.depth_min);
  const double room = std::max(height_ - 2 * radius, prior_.depth_min);
  return std::clamp(std::log(room), lowest, lattice_.log_depths().high());
}

std::vector<DepthModel::Cell> DepthModel::first_cells() const {
  const NodeAxis& radii = lattice_.radii();
  const NodeAxis& effects = lattice_.effects();
  const std::size_t wide = radii.count > 1 ? kRadiusCells : 1;
  const std::size_t hard = effects.count > 1 ? kRatioCells : 1;
  const double radius_width = (radii.high() - radii.low) / static_cast<double>(wide);
  const double lowest = std::log(ratio_of(effects.low));
  const double ratio_width =
      (std::log(ratio_of(effects.high())) - lowest) / static_cast<double>(hard);
  std::vector<Cell> cells;
  for (std::size_t j = 0; j < wide; ++j) {
    for (std::size_t k = 0; k < hard; ++k) {
      cells.push_back({.radius = radii.low + (static_cast<double>(j) + 0.5) * radius_width,
                       .radius_width = radius_width,
                       .log_ratio = lowest + (static_cast<double>(k) + 0.5) * ratio_width,
                       .ratio_width = ratio_width,
                       .best = {}});
    }
  }
  return cells;
}

/// The best depth of the cell's middle, and how much its edges differ in what they would give.
void DepthModel::look(const CurveMatcher& points, Cell& cell) const {
  const double low = lattice_.log_depths().low;
  const double high = deepest(cell.radius);
  const double effect = effect_of(std::exp(cell.log_ratio));
  const double guess = std::clamp(cell.log_depth, low, high);
  const double width = 2 * cell.depth_stddev;
  std::optional<Peak> peak;
  for (const int doublings : kDoublings) {
    if (peak || !(width > 0)) break;
    const double reach = (std::exp2(doublings + 1) - 1) * width;
    const CurveLine line = lattice_.line(cell.radius, effect, guess - reach, guess + reach);
    peak = search({low, high}, {guess, width, doublings}, [&](double log_depth) {
      return points.match(line.at(log_depth)).log_likelihood;
    });
  }
  if (!peak) {
    const CurveLine line = lattice_.line(cell.radius, effect, low, high);
    peak = scan(low, high, [&](double log_depth) {
      return points.match(line.at(log_depth)).log_likelihood;
    });
  }
  cell.log_depth = peak->at;
  const CurveTerms best = lattice_.at(peak->at, cell.radius, effect);
  cell.best = points.match(best);
  const bool pinned = peak->at <= low || peak->at >= high;
  measure(points, best, pinned, cell);
  cell.looked = true;
}

/// How far signal and depth move from the cell's middle to its edges.
void DepthModel::measure(const CurveMatcher& points,
                         const CurveTerms& best,
                         bool pinned,
                         Cell& cell) const {
  const double ratio = std::exp(cell.log_ratio);
  const double effect = effect_of(ratio);
  const auto slope = [&](double depth, double radius, double effects) {
    const CurveTerms up =
        lattice_.at(cell.log_depth + depth, cell.radius + radius, effect + effects);
    const CurveTerms down =
        lattice_.at(cell.log_depth - depth, cell.radius - radius, effect - effects);
    const double width = 2 * (depth + radius + effects);
    CurveTerms out{};
    for (std::size_t m = 0; m < kCurveTerms; ++m) out[m] = (up[m] - down[m]) / width;
    return out;
  };
  std::array<CurveTerms, 3> slopes{slope(0.01, 0, 0), slope(0, 5e-5, 0), slope(0, 0, 5e-3)};
  const double effect_slope = 2.5 * ratio / ((ratio + 1.5) * (ratio + 1.5));
  for (double& term : slopes[2]) term *= effect_slope;
  const auto information = points.information(best, slopes);
  const double range = lattice_.log_depths().high() - lattice_.log_depths().low;
  const double along = information[0][0] + 12 / (range * range);
  const auto reach = [&](std::size_t i, double width) {
    // As far as the depth cannot make up for it.
    const double followed = pinned ? 0 : information[0][i] * information[0][i] / along;
    return 0.5 * width * std::sqrt(std::max(0.0, information[i][i] - followed));
  };
  cell.depth_stddev = 1 / std::sqrt(along);
  cell.radius_reach = reach(1, cell.radius_width);
  cell.ratio_reach = reach(2, cell.ratio_width);
  const double moves = pinned ? 0 : -0.5 / along;
  cell.radius_shift = moves * information[0][1] * cell.radius_width;
  cell.ratio_shift = moves * information[0][2] * cell.ratio_width;
}

void DepthModel::split(const Cell& cell, bool wide, bool hard, std::vector<Cell>& out) {
  const int radius_parts = wide ? 2 : 1;
  const int ratio_parts = hard ? 2 : 1;
  for (int j = 0; j < radius_parts; ++j) {
    for (int k = 0; k < ratio_parts; ++k) {
      Cell part{.radius = cell.radius,
                .radius_width = cell.radius_width / radius_parts,
                .log_ratio = cell.log_ratio,
                .ratio_width = cell.ratio_width / ratio_parts,
                .best = {}};
      part.log_depth = cell.log_depth;
      part.depth_stddev = cell.depth_stddev;
      if (wide) {
        part.radius += (j - 0.5) * part.radius_width;
        part.log_depth += (j - 0.5) * cell.radius_shift;
      }
      if (hard) {
        part.log_ratio += (k - 0.5) * part.ratio_width;
        part.log_depth += (k - 0.5) * cell.ratio_shift;
      }
      out.push_back(part);
    }
  }
}

/// Halves cells until each is fine enough, and drops those out of reach.
std::vector<DepthModel::Cell> DepthModel::refine(const CurveMatcher& points,
                                                 std::vector<Cell> cells,
                                                 double shift_max) const {
  std::vector<Cell> fine;
  std::size_t lines = 0;
  double most = -std::numeric_limits<double>::infinity();
  while (!cells.empty()) {
    for (Cell& cell : cells) {
      if (!cell.looked) look(points, cell);
      most = std::max(most, cell.best.log_likelihood);
    }
    lines += cells.size();
    std::vector<Cell> next;
    for (const Cell& cell : cells) {
      const double away = std::sqrt(2 * std::max(0.0, most - cell.best.log_likelihood));
      if (away - kCaution * (cell.radius_reach + cell.ratio_reach) > kReach) continue;
      const bool wide = cell.radius_reach > kFine || std::abs(cell.radius_shift) > shift_max;
      const bool hard = cell.ratio_reach > kFine || std::abs(cell.ratio_shift) > shift_max;
      if ((!wide && !hard) || lines + next.size() > kLinesMax) {
        fine.push_back(cell);
        continue;
      }
      split(cell, wide, hard, next);
    }
    cells = std::move(next);
  }
  return fine;
}

/// Of the best depth's logarithm, within the cell: even, with the variance of both shifts together.
double DepthModel::blur(const Cell& cell) noexcept {
  return 2 * std::hypot(cell.radius_shift, cell.ratio_shift);
}

/// Of the prior, in radius and ratio.
double DepthModel::share(const Cell& cell) noexcept {
  double share = 1;
  if (cell.radius_width > 0) share *= cell.radius_width;
  if (cell.ratio_width > 0) share *= cell.ratio_width;
  return share;
}

/// The same for a cell that is one of many: a normal distribution.
void DepthModel::spread(const Cell& cell, std::vector<DepthMass>& out) const {
  const double low = lattice_.log_depths().low;
  const double high = deepest(cell.radius);
  const double width = 2 * kNormalReach / kNormalParts * cell.depth_stddev;
  for (int i = 0; i < kNormalParts; ++i) {
    const double off = (i - 0.5 * (kNormalParts - 1)) * width;
    const double at = cell.log_depth + off;
    if (at < low || at > high) continue;
    const double away = off / cell.depth_stddev;
    out.push_back(
        {at,
         std::hypot(width, blur(cell)),
         cell.best.log_likelihood - 0.5 * away * away + at + std::log(width * share(cell))});
  }
}

/// The posterior along the depth at the cell's middle, times the cell's share of the prior.
void DepthModel::integrate(const CurveMatcher& points,
                           const Cell& cell,
                           std::vector<DepthMass>& out) const {
  const double low = lattice_.log_depths().low;
  const double high = deepest(cell.radius);
  const CurveLine line = lattice_.line(cell.radius, effect_of(std::exp(cell.log_ratio)), low, high);
  const auto value = [&](double log_depth) {
    return points.match(line.at(log_depth)).log_likelihood;
  };
  const auto end = [&](double limit) {
    const double side = limit > cell.log_depth ? 1 : -1;
    double near = cell.log_depth;
    double far = cell.log_depth;
    double step = 3 * cell.depth_stddev;
    for (;;) {
      far = near + side * step;
      if (side * (limit - far) <= 0) return limit;
      if (value(far) < cell.best.log_likelihood - kNegligible) break;
      near = far;
      step *= 1.5;
    }
    for (int i = 0; i < 2; ++i) {
      const double middle = 0.5 * (near + far);
      (value(middle) < cell.best.log_likelihood - kNegligible ? far : near) = middle;
    }
    return far;
  };
  const double from = end(low);
  const double width = (end(high) - from) / static_cast<double>(kDepths);
  if (!(width > 0)) return;
  for (std::size_t i = 0; i < kDepths; ++i) {
    const double at = from + (static_cast<double>(i) + 0.5) * width;
    // Uniform in the depth, not in its logarithm.
    out.push_back(
        {at, std::hypot(width, blur(cell)), value(at) + at + std::log(width * share(cell))});
  }
}

/// Coarsely first; then cells within which the depth moves little against what is known of it.
std::vector<DepthModel::Cell> DepthModel::cells_of(const CurveMatcher& points,
                                                   std::vector<Cell> cells) const {
  cells = refine(points, std::move(cells), std::numeric_limits<double>::infinity());
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<DepthMass> masses;
    masses.reserve(cells.size());
    for (const Cell& cell : cells) {
      masses.push_back(
          {cell.log_depth,
           std::hypot(std::sqrt(12.0) * cell.depth_stddev, blur(cell)),
           cell.best.log_likelihood + cell.log_depth + std::log(cell.depth_stddev * share(cell))});
    }
    const DepthDistribution rough{masses, prior_.depth_min, prior_.depth_max};
    cells = refine(points, std::move(cells), kShift * rough.stddev() / rough.mean());
  }
  return cells;
}

/// Of the prior's measure as integrate() counts it.
double DepthModel::log_prior_total() const {
  const NodeAxis& radii = lattice_.radii();
  const NodeAxis& effects = lattice_.effects();
  constexpr int kParts = 64;
  const double lowest = std::exp(lattice_.log_depths().low);
  double total = 0;
  for (int i = 0; i < kParts; ++i) {
    const double radius = radii.low + (radii.high() - radii.low) * (i + 0.5) / kParts;
    total += (std::exp(deepest(radius)) - lowest) / kParts;
  }
  if (radii.count > 1) total *= radii.high() - radii.low;
  if (effects.count > 1) total *= std::log(ratio_of(effects.high()) / ratio_of(effects.low));
  return std::log(total);
}

NormalEquations DepthModel::sums(const Input& input,
                                 double surface,
                                 const std::optional<TouchModel>& expected) const {
  const SensorSteps steps{input.noise, input.quantum};
  NormalEquations out{surface};
  if (input.settled != nullptr) {
    out = *input.settled;
    out.move_to(surface);
  }
  for (const Touch& touch : input.touches) {
    out.add(touch,
            {.basis = basis_,
             .steps = steps,
             .cut_off = input.cut_off,
             .noise = input.noise,
             .expected = expected});
  }
  return out;
}

void DepthModel::settle(const Input& input, const TouchModel& expected, NormalEquations& to) const {
  to.move_to(expected.surface);
  to.add(sums(input, expected.surface, expected));
}

DepthPosterior DepthModel::update(const Input& input) const {
  DepthPosterior posterior;
  posterior.best.surface = input.surface;
  std::optional<TouchModel> expected = input.expected;
  double surface = expected ? expected->surface : input.surface;
  CurveMatcher points{sums(input, surface, expected), input.stiffness, input.surface};
  CurveMatch plain = points.match(kPlainTerms);
  // The surface enters the model to first order, and what the steps make of a force is computed
  // with the force expected: again from what fitted best.
  const int moves = input.expected ? 1 : 2;
  std::vector<Cell> cells = first_cells();
  for (int move = 0; move < moves; ++move) {
    CurveMatch best = plain;
    posterior.best.curve = kPlainTerms;
    for (Cell& cell : cells) {
      look(points, cell);
      cell.looked = false;  // the next look begins where this one ended
      if (cell.best.log_likelihood < best.log_likelihood) continue;
      best = cell.best;
      posterior.best.curve =
          lattice_.at(cell.log_depth, cell.radius, effect_of(std::exp(cell.log_ratio)));
    }
    surface += std::clamp(best.shift, -kSurfaceSpread, kSurfaceSpread);
    posterior.best.surface = surface;
    posterior.best.scale = best.stiffness.scale;
    posterior.best.rate_factor = best.stiffness.rate_factor;
    points = CurveMatcher{sums(input, surface, posterior.best), input.stiffness, input.surface};
    plain = points.match(kPlainTerms);
  }
  cells = cells_of(points, std::move(cells));
  std::vector<DepthMass> masses;
  double most = -std::numeric_limits<double>::infinity();
  double least = plain.misfit;
  for (const Cell& cell : cells) {
    most = std::max(most, cell.best.log_likelihood);
    least = std::min(least, cell.best.misfit);
    const bool narrow = cells.size() > kMany && cell.depth_stddev < kNarrow;
    narrow ? spread(cell, masses) : integrate(points, cell, masses);
  }
  posterior.misfit = points.weights() > 0 ? std::sqrt(std::max(0.0, least) / points.weights()) : 0;
  posterior.gain = 2 * (most - plain.log_likelihood);
  posterior.plain = plain.stiffness;
  const DepthDistribution depth{masses, prior_.depth_min, prior_.depth_max};
  posterior.log_evidence = depth.log_total() - log_prior_total() - plain.log_likelihood;
  posterior.depth = depth.quantile(0.5);
  posterior.depth_stddev = depth.stddev();
  const DepthDistribution::Interval interval = depth.interval();
  posterior.depth_low = interval.low;
  posterior.depth_high = interval.high;
  posterior.excluded = excluded(points, plain.log_likelihood);
  return posterior;
}

/// Down to where every inclusion of kShowingRadius or more would have been seen. A stiffer one
/// shows more, so one ratio speaks for those above it.
double DepthModel::excluded(const CurveMatcher& points, double plain) const {
  const NodeAxis& radii = showing_.radii();
  const NodeAxis& depths = showing_.log_depths();
  std::size_t shown = depths.count;
  for (std::size_t j = 0; j < radii.count && shown > 0; j += kShowingStride) {
    const CurveLine line =
        showing_.line(radii.node(j), showing_.effects().low, depths.low, depths.high());
    for (std::size_t i = 0; i < shown; ++i) {
      if (points.match(line.at(depths.node(i))).log_likelihood < plain - kExcluded) continue;
      shown = i;
    }
  }
  return shown > 0 ? std::exp(depths.node(shown - 1)) : 0;
}

}  // namespace palp::estimator
