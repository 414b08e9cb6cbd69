#include "patient_site/estimator/depth_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palp::estimator {
namespace {

constexpr std::size_t kRadiusCells = 6;  // to begin with
constexpr std::size_t kEffectCells = 4;
constexpr std::size_t kLinesMax = 700;  // a bound on the time
constexpr double kReach = 4.5;          // [-], standard deviations below the best: forgotten
constexpr double kFine = 0.7;           // [-], standard deviations to a cell's edge: fine enough
constexpr double kCaution = 1.4;        // [-], the information changes within a cell
constexpr std::size_t kScan = 12;       // depths looked at first
constexpr int kSearchSteps = 24;
constexpr double kPeakExact = 0.01;   // [-], of the log-likelihood
constexpr double kNegligible = 10;    // [-], log-likelihood below a line's best: its ends
constexpr std::size_t kDepths = 21;   // of one line, summed
constexpr double kShowing = 5e-3;     // [m], radius of which "excluded" speaks
constexpr double kShowingRatio = 10;  // [-], and how much stiffer it is at least
constexpr double kExcluded = 3;       // [-], log of 20

/// Maximum of `value` between the first and the last of three places, the middle one above both:
/// parabolas, golden sections where they lead nowhere.
struct Peak {
  double at{};
  double value{};
};
template <typename Value>
Peak climb(std::array<Peak, 3> bracket, const Value& value) {
  for (int i = 0; i < kSearchSteps; ++i) {
    auto& [left, middle, right] = bracket;
    const double a = middle.at - left.at;
    const double b = right.at - middle.at;
    const double rise = (middle.value - left.value) / a;
    const double fall = (middle.value - right.value) / b;
    const double curvature = (rise + fall) / (a + b);  // half of it, negative
    // Vertex of the parabola.
    double step = curvature > 0 ? 0.5 * (rise * b - fall * a) / (rise + fall) : 0;
    const double gain = curvature * step * step;
    const bool exact =
        gain < kPeakExact && std::max(left.value, right.value) > middle.value - 1 / kPeakExact;
    if (exact) return {middle.at, middle.value};
    const bool slow = std::abs(step) < 0.02 * std::min(a, b);
    if (slow) step = 0.3 * (a > b ? -a : b);
    if (!(step > -a && step < b)) step = 0.4 * (a > b ? -a : b);
    const Peak next{middle.at + step, value(middle.at + step)};
    if (next.value > middle.value) {
      (step > 0 ? left : right) = middle;
      middle = next;
    } else {
      (step > 0 ? right : left) = next;
    }
  }
  return bracket[1];
}

}  // namespace

DepthModel::DepthModel(const fem::DepthDatabase& database, const DepthPrior& prior)
    : prior_{prior},
      height_{database.grid().block.height},
      lattice_{database, prior},
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
  const std::size_t hard = effects.count > 1 ? kEffectCells : 1;
  const double radius_width = (radii.high() - radii.low) / static_cast<double>(wide);
  const double effect_width = (effects.high() - effects.low) / static_cast<double>(hard);
  std::vector<Cell> cells;
  for (std::size_t j = 0; j < wide; ++j) {
    for (std::size_t k = 0; k < hard; ++k) {
      cells.push_back({.radius = radii.low + (static_cast<double>(j) + 0.5) * radius_width,
                       .radius_width = radius_width,
                       .effect = effects.low + (static_cast<double>(k) + 0.5) * effect_width,
                       .effect_width = effect_width,
                       .best = {}});
    }
  }
  return cells;
}

/// The best depth of the cell's middle, and how much its edges differ in what they would give.
void DepthModel::look(const CurveMatcher& points, Cell& cell) const {
  const CurveLine line = lattice_.line(cell.radius, cell.effect);
  const double low = lattice_.log_depths().low;
  const double high = deepest(cell.radius);
  const auto value = [&](double log_depth) {
    return points.match(line.at(log_depth)).log_likelihood;
  };
  const double step = (high - low) / static_cast<double>(kScan - 1);
  std::array<Peak, kScan> scan;
  for (std::size_t i = 0; i < kScan; ++i) {
    const double at = low + step * static_cast<double>(i);
    scan[i] = {at, value(at)};
  }
  const auto top = std::max_element(
      scan.begin(), scan.end(), [](const Peak& a, const Peak& b) { return a.value < b.value; });
  Peak peak = *top;
  if (top == scan.begin() || top + 1 == scan.end()) {
    // The peak may lie just inside the end.
    const double inward = top == scan.begin() ? step : -step;
    for (double part = 0.5; part > 1e-4; part *= 0.5) {
      const Peak inside{top->at + part * inward, value(top->at + part * inward)};
      if (inside.value <= top->value) continue;
      const Peak beyond{top->at + 2 * part * inward, value(top->at + 2 * part * inward)};
      peak =
          inward > 0 ? climb({*top, inside, beyond}, value) : climb({beyond, inside, *top}, value);
      break;
    }
  } else {
    peak = climb({*(top - 1), *top, *(top + 1)}, value);
  }
  cell.log_depth = peak.at;
  const CurveTerms best = line.at(peak.at);
  cell.best = points.match(best);

  const auto slope = [&](double depth, double radius, double effect) {
    const CurveTerms up =
        lattice_.at(cell.log_depth + depth, cell.radius + radius, cell.effect + effect);
    const CurveTerms down =
        lattice_.at(cell.log_depth - depth, cell.radius - radius, cell.effect - effect);
    const double width = 2 * (depth + radius + effect);
    CurveTerms out{};
    for (std::size_t m = 0; m < kCurveTerms; ++m) out[m] = (up[m] - down[m]) / width;
    return out;
  };
  const auto information =
      points.information(best, {slope(0.01, 0, 0), slope(0, 5e-5, 0), slope(0, 0, 5e-3)});
  const double along = information[0][0] + 12 / ((high - low) * (high - low) + 1e-12);
  const bool pinned = peak.at == scan.front().at || peak.at == scan.back().at;
  const auto reach = [&](std::size_t i, double width) {
    // As far as the depth cannot make up for it.
    const double followed = pinned ? 0 : information[0][i] * information[0][i] / along;
    return 0.5 * width * std::sqrt(std::max(0.0, information[i][i] - followed));
  };
  cell.depth_stddev = 1 / std::sqrt(along);
  cell.radius_reach = reach(1, cell.radius_width);
  cell.effect_reach = reach(2, cell.effect_width);
}

/// Halves cells until each is fine enough, and drops those out of reach.
std::vector<DepthModel::Cell> DepthModel::refine(const CurveMatcher& points,
                                                 std::vector<Cell> cells,
                                                 double& most) const {
  std::vector<Cell> fine;
  std::size_t lines = 0;
  while (!cells.empty()) {
    for (Cell& cell : cells) {
      look(points, cell);
      most = std::max(most, cell.best.log_likelihood);
    }
    lines += cells.size();
    std::vector<Cell> next;
    for (const Cell& cell : cells) {
      const double away = std::sqrt(2 * std::max(0.0, most - cell.best.log_likelihood));
      if (away - kCaution * (cell.radius_reach + cell.effect_reach) > kReach) continue;
      const int radius_parts = cell.radius_reach > kFine ? 2 : 1;
      const int effect_parts = cell.effect_reach > kFine ? 2 : 1;
      if (radius_parts * effect_parts == 1 || lines + next.size() > kLinesMax) {
        fine.push_back(cell);
        continue;
      }
      for (int j = 0; j < radius_parts; ++j) {
        for (int k = 0; k < effect_parts; ++k) {
          Cell part = cell;
          part.radius_width = cell.radius_width / radius_parts;
          part.effect_width = cell.effect_width / effect_parts;
          if (radius_parts > 1) part.radius += (j - 0.5) * part.radius_width;
          if (effect_parts > 1) part.effect += (k - 0.5) * part.effect_width;
          next.push_back(part);
        }
      }
    }
    cells = std::move(next);
  }
  return fine;
}

/// The posterior along the depth at the cell's middle, times the cell's share of the prior.
void DepthModel::integrate(const CurveMatcher& points,
                           const Cell& cell,
                           std::vector<Mass>& out) const {
  const CurveLine line = lattice_.line(cell.radius, cell.effect);
  const double low = lattice_.log_depths().low;
  const double high = deepest(cell.radius);
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
  double share = 1;
  if (cell.radius_width > 0) share *= cell.radius_width;
  if (cell.effect_width > 0) {
    share *= std::log(ratio_of(cell.effect + 0.5 * cell.effect_width) /
                      ratio_of(cell.effect - 0.5 * cell.effect_width));
  }
  for (std::size_t i = 0; i < kDepths; ++i) {
    const double at = from + (static_cast<double>(i) + 0.5) * width;
    // Uniform in the depth, not in its logarithm.
    out.push_back({at, width, value(at) + at + std::log(width * share)});
  }
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

DepthPosterior DepthModel::update(const Input& input) const {
  DepthPosterior posterior;
  Input here = input;
  CurveMatcher points{basis_, here};
  CurveMatch plain = points.match(kPlainTerms);
  // The surface enters the model to first order: again from where the best curve puts it.
  constexpr int kMoves = 2;
  for (int move = 0; move < kMoves; ++move) {
    CurveMatch best = plain;
    for (Cell& cell : first_cells()) {
      look(points, cell);
      if (cell.best.log_likelihood > best.log_likelihood) best = cell.best;
    }
    here.surface += std::clamp(best.shift, -kSurfaceSpread, kSurfaceSpread);
    points = CurveMatcher{basis_, here};
    plain = points.match(kPlainTerms);
  }
  double most = -std::numeric_limits<double>::infinity();
  const std::vector<Cell> cells = refine(points, first_cells(), most);
  double least = plain.misfit;
  std::vector<Mass> masses;
  masses.reserve(cells.size() * kDepths);
  for (const Cell& cell : cells) {
    least = std::min(least, cell.best.misfit);
    integrate(points, cell, masses);
  }
  posterior.misfit = points.weights() > 0 ? std::sqrt(std::max(0.0, least) / points.weights()) : 0;
  posterior.gain = 2 * (most - plain.log_likelihood);
  posterior.plain = {.scale = plain.scale,
                     .scale_stddev = plain.scale_stddev,
                     .rate_factor = plain.rate_factor,
                     .rate_factor_stddev = plain.rate_factor_stddev};
  summarise(masses, plain.log_likelihood, posterior);
  posterior.excluded = excluded(points, plain.log_likelihood);
  return posterior;
}

void DepthModel::summarise(std::vector<Mass>& masses,
                           double plain,
                           DepthPosterior& posterior) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Mass& mass : masses) most = std::max(most, mass.log_mass);
  std::erase_if(masses, [&](const Mass& mass) { return !(mass.log_mass > most - 20); });
  std::sort(masses.begin(), masses.end(), [](const Mass& a, const Mass& b) {
    return a.log_depth < b.log_depth;
  });
  double total = 0;
  double mean = 0;
  double square = 0;
  for (const Mass& mass : masses) {
    const double share = std::exp(mass.log_mass - most);
    const double depth = std::exp(mass.log_depth);
    total += share;
    mean += share * depth;
    square += share * depth * depth;
  }
  posterior.log_evidence = total > 0 ? std::log(total) + most - log_prior_total() - plain
                                     : -std::numeric_limits<double>::infinity();
  posterior.depth = mean / total;
  posterior.depth_stddev =
      std::sqrt(std::max(0.0, square / total - posterior.depth * posterior.depth));
  // A mass counts half where it lies; between two, the share grows evenly.
  const auto quantile = [&](double level) {
    double sum = 0;
    double before = 0;
    double at = masses.empty() ? 0 : masses.front().log_depth - 0.5 * masses.front().width;
    for (const Mass& mass : masses) {
      const double share = std::exp(mass.log_mass - most) / total;
      const double here = sum + 0.5 * share;
      if (here >= level) {
        return std::exp(at + (mass.log_depth - at) * (level - before) / (here - before));
      }
      at = mass.log_depth;
      before = here;
      sum += share;
    }
    return std::exp(at + 0.5 * masses.back().width);
  };
  if (masses.empty()) return;
  posterior.depth_low = quantile(0.025);
  posterior.depth_high = quantile(0.975);
}

/// Down to where every inclusion of kShowing or more would have been seen.
double DepthModel::excluded(const CurveMatcher& points, double plain) const {
  const NodeAxis& radii = lattice_.radii();
  const NodeAxis& effects = lattice_.effects();
  const NodeAxis& depths = lattice_.log_depths();
  const double effect = std::clamp(effect_of(kShowingRatio), effects.low, effects.high());
  const double smallest = std::clamp(kShowing, radii.low, radii.high());
  constexpr int kParts = 6;
  std::size_t shown = depths.count;
  for (int j = 0; j <= kParts && shown > 0; ++j) {
    const double radius = smallest + (radii.high() - smallest) * j / kParts;
    const CurveLine line = lattice_.line(radius, effect);
    for (std::size_t i = 0; i < shown; ++i) {
      if (points.match(line.at(depths.node(i))).log_likelihood < plain - kExcluded) continue;
      shown = i;
    }
  }
  return shown > 0 ? std::exp(depths.node(shown - 1)) : 0;
}

}  // namespace palp::estimator
