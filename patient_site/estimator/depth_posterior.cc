#include "patient_site/estimator/depth_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/core/check.h"

namespace palp::estimator {
namespace {

constexpr double kStep = 25e-6;   // [m], of the tables
constexpr double kBin = 0.1e-3;   // [m], points closer than this are one
constexpr double kNear = 0.3e-3;  // [m], how far off the surface may be
constexpr std::size_t kDepthNodes = 40;
constexpr std::size_t kRadiusNodes = 9;
constexpr std::size_t kRatioNodes = 5;
constexpr std::size_t kFine = 8;  // depths between two nodes, when summing
constexpr std::size_t kFineRadius = 8;
constexpr std::size_t kFineRatio = 3;
constexpr double kDeepest = 4.05e-3;  // [m], of the points: the filters' share is known to there
constexpr std::size_t kManyTables = 500;  // from here the surface is sought with
constexpr std::size_t kStride = 7;        // one in so many
constexpr double kNegligible = 40;        // [-], below the best log-likelihood
constexpr double kForgotten = 2000;       // [-], the same between coarse nodes
constexpr double kShowing = 5e-3;         // [m], radius of which "excluded" speaks
constexpr double kExcluded = 3;           // [-], log of 20

/// n nodes of [low, high], evenly in the logarithm; one if the ends are equal.
std::vector<double> log_nodes(double low, double high, std::size_t count) {
  if (!(high > low * (1 + 1e-9))) return {low};
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(low *
                  std::pow(high / low, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return out;
}

/// Values on `count` even steps, made `fine` times denser by Catmull-Rom cubics.
std::vector<double> denser(const std::vector<double>& values, std::size_t fine) {
  if (values.size() == 1) return values;
  std::vector<double> out;
  const auto at = [&](std::ptrdiff_t i) {
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    if (i < 0) return 2 * values[0] - values[1];
    if (i > last) return 2 * values[values.size() - 1] - values[values.size() - 2];
    return values[static_cast<std::size_t>(i)];
  };
  for (std::size_t cell = 0; cell + 1 < values.size(); ++cell) {
    const auto i = static_cast<std::ptrdiff_t>(cell);
    const double a = at(i - 1);
    const double b = at(i);
    const double c = at(i + 1);
    const double d = at(i + 2);
    for (std::size_t k = 0; k < fine; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(fine);
      out.push_back(b + 0.5 * t *
                            (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))));
    }
  }
  out.push_back(values.back());
  return out;
}

/// n even nodes of [low, high]; one if the ends are equal.
std::vector<double> even_nodes(double low, double high, std::size_t count) {
  if (!(high > low * (1 + 1e-9))) return {low};
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return out;
}

/// What a ball of ratio k does to the field far from it: the excess force is nearly proportional to
/// this, so a log-likelihood is nearly a parabola in it.
double effect_of(double ratio) { return (ratio - 1) / (ratio + 1.5); }
double ratio_of(double effect) { return (1 + 1.5 * effect) / (1 - effect); }

std::vector<double> ratio_nodes(double low, double high, std::size_t count) {
  std::vector<double> out;
  for (const double effect : even_nodes(effect_of(low), effect_of(high), count)) {
    out.push_back(ratio_of(effect));
  }
  return out;
}

/// Shares of a prior even in the logarithm of the ratio, on nodes even in the effect.
std::vector<double> ratio_shares(double low, double high, std::size_t count) {
  std::vector<double> out;
  const double begin = effect_of(low);
  const double step =
      (effect_of(high) - begin) / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = begin + step * static_cast<double>(i);
    const double from = ratio_of(std::max(begin, at - 0.5 * step));
    const double to =
        ratio_of(std::min(begin + step * static_cast<double>(count - 1), at + 0.5 * step));
    out.push_back(count > 1 ? std::log(to / from) : 1);
  }
  return out;
}

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Inverse of a symmetric positive matrix, and its determinant.
double invert(const Matrix3& m, Matrix3& out) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3;
      const std::size_t b = (j + 2) % 3;
      const std::size_t c = (i + 1) % 3;
      const std::size_t d = (i + 2) % 3;
      out[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  }
  const double det = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
  for (auto& row : out) {
    for (double& value : row) value /= det;
  }
  return det;
}

}  // namespace

DepthModel::DepthModel(const fem::DepthDatabase& database, const DepthPrior& prior)
    : prior_{prior},
      depths_{log_nodes(prior.depth_min, prior.depth_max, kDepthNodes)},
      radii_{even_nodes(prior.radius_min, prior.radius_max, kRadiusNodes)},
      ratios_{ratio_nodes(prior.ratio_min, prior.ratio_max, kRatioNodes)},
      plain_{tabulate(database, database.plain())} {
  for (const double depth : depths_) {
    for (const double radius : radii_) {
      for (const double ratio : ratios_) {
        tables_.push_back(tabulate(
            database,
            database.curve(
                {.shape = prior.shape, .depth = depth, .radius = radius, .ratio = ratio})));
      }
    }
  }
}

DepthModel::Table DepthModel::tabulate(const fem::DepthDatabase& database,
                                       const fem::DepthDatabase::Curve& curve) const {
  // Also beyond what was solved: every curve must answer for the same points.
  Table table;
  const auto count = static_cast<std::size_t>((kDeepest + kNear) / kStep) + 3;
  for (std::size_t i = 0; i < count; ++i) {
    table.force.push_back(database.force(curve, static_cast<double>(i) * kStep));
  }
  return table;
}

std::vector<DepthModel::Place> DepthModel::locate(const Input& input, double surface) const {
  std::vector<Place> places;
  // Loading and unloading stay apart: points come branch by branch, in order of position.
  double begin = -std::numeric_limits<double>::infinity();
  ContactPoint sum;
  const auto finish = [&] {
    if (!(sum.count > 0)) return;
    Place place;
    place.indentation = sum.position / sum.count - surface;
    place.force = sum.force / sum.count;
    place.rate = sum.rate / sum.count;
    place.weight = sum.count / (input.noise * input.noise);
    sum = {};
    if (place.indentation > kDeepest || place.indentation < -kNear) return;
    const double entry = std::max(0.0, place.indentation / kStep);
    place.entry = static_cast<std::size_t>(entry);
    place.share = entry - static_cast<double>(place.entry);
    places.push_back(place);
  };
  for (const ContactPoint& point : input.points) {
    if (point.position > begin + kBin || point.position < begin) {
      finish();
      begin = point.position;
    }
    sum.position += point.count * point.position;
    sum.force += point.count * point.force;
    sum.rate += point.count * point.rate;
    sum.count += point.count;
  }
  finish();
  return places;
}

/// Least squares for (e, e s, e v): force = e F(x) + e s (-F'(x)) + e v F(x) rate.
DepthModel::Match DepthModel::match(const Table& table,
                                    std::span<const Place> places,
                                    const StiffnessPrior& stiffness) const {
  Matrix3 normal{};
  std::array<double, 3> right{};
  double squares = 0;
  const double scale_weight = 1 / (stiffness.scale_stddev * stiffness.scale_stddev);
  const double rate_width = stiffness.scale * stiffness.rate_factor_stddev;
  const double rate_weight = 1 / (rate_width * rate_width);
  const double rate_mean = stiffness.scale * stiffness.rate_factor;
  normal[0][0] = scale_weight;
  normal[1][1] = 1 / (kNear * kNear);
  normal[2][2] = rate_weight;
  right[0] = scale_weight * stiffness.scale;
  right[2] = rate_weight * rate_mean;
  squares = scale_weight * stiffness.scale * stiffness.scale + rate_weight * rate_mean * rate_mean;
  for (const Place& place : places) {
    const double low = table.force[place.entry];
    const double high = table.force[place.entry + 1];
    const bool air = place.indentation <= 0;
    const double force = air ? 0 : low + place.share * (high - low);
    const double slope = air ? 0 : (high - low) / kStep;
    const std::array<double, 3> x{force, -slope, force * place.rate};
    const double w = place.weight;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) normal[i][j] += w * x[i] * x[j];
      right[i] += w * x[i] * place.force;
    }
    squares += w * place.force * place.force;
  }
  normal[0][1] = normal[1][0];
  normal[0][2] = normal[2][0];
  normal[1][2] = normal[2][1];
  Matrix3 inverse{};
  const double det = invert(normal, inverse);
  std::array<double, 3> solution{};
  double explained = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) solution[i] += inverse[i][j] * right[j];
    explained += solution[i] * right[i];
  }
  Match out;
  out.misfit = squares - explained;
  out.log_likelihood = -0.5 * out.misfit - 0.5 * std::log(det);
  out.scale = solution[0];
  out.scale_stddev = std::sqrt(inverse[0][0]);
  out.rate_factor = solution[2] / solution[0];
  out.rate_factor_stddev = std::sqrt(inverse[2][2]) / solution[0];
  out.shift = solution[1] / solution[0];
  return out;
}

DepthPosterior DepthModel::update(const Input& input) const {
  DepthPosterior posterior;
  double surface = input.surface;
  // The surface enters the model to first order: once more from where the best curve puts it.
  std::vector<Place> places;
  Match plain;
  const std::size_t stride = tables_.size() > kManyTables ? kStride : 1;
  for (int pass = 0; pass < 3; ++pass) {
    places = locate(input, surface);
    plain = match(plain_, places, input.stiffness);
    Match best = plain;
    for (std::size_t i = 0; i < tables_.size(); i += stride) {
      const Match one = match(tables_[i], places, input.stiffness);
      if (one.log_likelihood > best.log_likelihood) best = one;
    }
    if (pass == 2) break;
    surface += std::clamp(best.shift, -kNear, kNear);
  }
  std::vector<double> log_likelihood;
  log_likelihood.reserve(tables_.size());
  double least = plain.misfit;
  double most = -std::numeric_limits<double>::infinity();
  for (const Table& table : tables_) {
    const Match one = match(table, places, input.stiffness);
    log_likelihood.push_back(one.log_likelihood);
    most = std::max(most, one.log_likelihood);
    least = std::min(least, one.misfit);
  }
  double weights = 0;
  for (const Place& place : places) weights += place.weight;
  posterior.misfit = weights > 0 ? std::sqrt(std::max(0.0, least) / weights) : 0;
  posterior.gain = 2 * (most - plain.log_likelihood);
  posterior.plain = {.scale = plain.scale,
                     .scale_stddev = plain.scale_stddev,
                     .rate_factor = plain.rate_factor,
                     .rate_factor_stddev = plain.rate_factor_stddev};
  summarise(log_likelihood, plain.log_likelihood, posterior);
  return posterior;
}

void DepthModel::summarise(const std::vector<double>& log_likelihood,
                           double plain,
                           DepthPosterior& posterior) const {
  const std::size_t radii = radii_.size();
  const std::size_t ratios = ratios_.size();
  const auto at = [&](std::size_t depth, std::size_t radius, std::size_t ratio) {
    return log_likelihood[(depth * radii + radius) * ratios + ratio];
  };
  // Along the ratio and the radius first, then each of those lines along the depth.
  std::vector<std::vector<std::vector<double>>> lines(depths_.size());  // depth, radius, ratio
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    std::vector<std::vector<double>> by_radius;
    for (std::size_t j = 0; j < radii; ++j) {
      std::vector<double> values;
      for (std::size_t k = 0; k < ratios; ++k) values.push_back(at(i, j, k));
      by_radius.push_back(denser(values, kFineRatio));
    }
    const std::size_t fine_ratios = by_radius[0].size();
    for (std::size_t k = 0; k < fine_ratios; ++k) {
      std::vector<double> values;
      for (std::size_t j = 0; j < radii; ++j) values.push_back(by_radius[j][k]);
      lines[i].push_back(denser(values, kFineRadius));
    }
  }
  const std::size_t fine_ratios = lines[0].size();
  const std::size_t fine_radii = lines[0][0].size();
  const std::size_t fine_depths = (depths_.size() - 1) * kFine + 1;
  std::vector<double> mass(fine_depths);
  std::vector<double> prior_of(fine_depths);  // uniform in depth, on nodes even in its logarithm
  double prior_depth = 0;
  for (std::size_t i = 0; i < fine_depths; ++i) {
    prior_of[i] =
        depths_[0] * std::pow(depths_.back() / depths_[0],
                              static_cast<double>(i) / static_cast<double>(fine_depths - 1));
    if (i == 0 || i + 1 == fine_depths) prior_of[i] *= 0.5;
    prior_depth += prior_of[i];
  }
  double most = plain;
  for (const double value : log_likelihood) most = std::max(most, value);
  double total = 0;
  double prior_total = 0;
  const std::vector<double> shares = ratio_shares(ratios_.front(), ratios_.back(), fine_ratios);
  std::vector<double> values(depths_.size());
  for (std::size_t k = 0; k < fine_ratios; ++k) {
    for (std::size_t j = 0; j < fine_radii; ++j) {
      const bool radius_end = fine_radii > 1 && (j == 0 || j + 1 == fine_radii);
      const double here = shares[k] * (radius_end ? 0.5 : 1);
      double line_most = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < depths_.size(); ++i) {
        values[i] = lines[i][k][j];
        line_most = std::max(line_most, values[i]);
      }
      prior_total += here * prior_depth;
      // Between nodes a line may rise above them, but not by this much.
      if (line_most < most - kForgotten) continue;
      const std::vector<double> fine = denser(values, kFine);
      for (std::size_t i = 0; i < fine.size(); ++i) {
        if (fine[i] < most - kNegligible) continue;
        mass[i] += here * prior_of[i] * std::exp(fine[i] - most);
      }
    }
  }
  for (const double one : mass) total += one;
  posterior.log_evidence = total > 0 ? std::log(total / prior_total) + most - plain
                                     : -std::numeric_limits<double>::infinity();
  double mean = 0;
  double square = 0;
  double sum = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const double depth =
        depths_[0] * std::pow(depths_.back() / depths_[0],
                              static_cast<double>(i) / static_cast<double>(mass.size() - 1));
    const double before = sum / total;
    sum += mass[i];
    mean += mass[i] * depth / total;
    square += mass[i] * depth * depth / total;
    // Each mass is spread to half the way to its neighbours.
    const double step =
        std::pow(depths_.back() / depths_[0], 1 / static_cast<double>(mass.size() - 1)) - 1;
    const auto quantile = [&](double level, double& to) {
      if (before < level && sum / total >= level) {
        const double part = (level - before) / (sum / total - before);
        to = depth * (1 + step * (part - 0.5));
      }
    };
    quantile(0.025, posterior.depth_low);
    quantile(0.975, posterior.depth_high);
  }
  posterior.depth = mean;
  posterior.depth_stddev = std::sqrt(std::max(0.0, square - mean * mean));
  // Down to where every inclusion of kShowing or more, of a middling ratio, would have been seen.
  posterior.excluded = 0;
  for (std::size_t i = 0; i < depths_.size(); ++i) {
    bool all = true;
    for (std::size_t j = 0; j < radii; ++j) {
      if (radii_[j] < kShowing * 0.99) continue;
      all &= at(i, j, ratios / 2) < plain - kExcluded;
    }
    if (!all) break;
    posterior.excluded = depths_[i];
  }
}

}  // namespace palp::estimator
