#include "depth/curve_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/core/formatted.h"
#include "depth/least_squares.h"

namespace palp::depth {
namespace {

// So dense that the cubics between them miss the database's curves by less than 0.1 mN, a quarter
// of what the noise leaves of the mean of eight strokes.
constexpr std::size_t kRadii = 17;
constexpr std::size_t kEffects = 9;
constexpr std::size_t kSamples = 20;  // of a curve, to fit its terms

NodeAxis axis(double low, double high, std::size_t count) {
  if (!(high > low * (1 + 1e-9))) return {.low = low, .step = 0, .count = 1};
  return {.low = low, .step = (high - low) / static_cast<double>(count - 1), .count = count};
}

NodeAxis log_axis(const DepthPrior& prior) {
  constexpr double kNarrowest = 1e-3;  // [-], of a depth known exactly
  const double low = std::log(prior.depth_min);
  const double high = std::max(std::log(prior.depth_max), low + kNarrowest);
  return {.low = low,
          .step = (high - low) / static_cast<double>(CurveLine::kDepths - 1),
          .count = CurveLine::kDepths};
}

/// Least squares of the excess, as a linear map from samples to terms: weighed by the force.
class Shortening {
 public:
  explicit Shortening(const DepthDatabase& database) : plain_curve_{database.plain()} {
    for (std::size_t i = 0; i < kSamples; ++i) {
      // Chebyshev's nodes hold the polynomial at both ends.
      const double angle = std::numbers::pi * (static_cast<double>(i) + 0.5) / kSamples;
      indentation_[i] = 0.5 * kCurveReach * (1 - std::cos(angle));
      plain_[i] = database.force(plain_curve_, indentation_[i]);
    }
    for (std::size_t i = 0; i < kSamples; ++i) {
      LeastSquares<kCurveTerms> fit;  // of a curve that is 1 at sample i and 0 elsewhere
      for (std::size_t j = 0; j < kSamples; ++j) {
        const double weight = plain_[j] * plain_[j] / (plain_.back() * plain_.back());
        fit.add(curve_polynomials(indentation_[j]), i == j ? 1 : 0, weight);
      }
      map_[i] = fit.solve().x;
    }
  }

  [[nodiscard]] CurveTerms operator()(const DepthDatabase& database,
                                      const DepthDatabase::Curve& curve) const {
    CurveTerms out{};
    const auto relative_at = [&](double indentation) {
      return database.force(curve, indentation) / database.force(plain_curve_, indentation);
    };
    // Beyond what was solved no point will lie: a straight line keeps the polynomial quiet there.
    const double solved = std::min(curve.indentation_max, kCurveReach);
    const double end = relative_at(solved);
    const double slope = (end - relative_at(0.95 * solved)) / (0.05 * solved);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double beyond = indentation_[i] - solved;
      const double relative = beyond > 0 ? end + slope * beyond : relative_at(indentation_[i]);
      for (std::size_t m = 0; m < kCurveTerms; ++m) out[m] += map_[i][m] * relative;
    }
    return out;
  }

 private:
  DepthDatabase::Curve plain_curve_;
  std::array<double, kSamples> indentation_{};  ///< [m]
  std::array<double, kSamples> plain_{};        ///< [N]
  std::array<CurveTerms, kSamples> map_{};
};

void add(CurveTerms& sum, const CurveTerms& terms, double weight) noexcept {
  for (std::size_t m = 0; m < kCurveTerms; ++m) sum[m] += weight * terms[m];
}

}  // namespace

Result<DepthPrior> known_part(const DepthPrior& prior, const fem::DepthGrid& grid) {
  DepthPrior out = prior;
  struct Side {
    const char* name;
    double DepthPrior::*low;
    double DepthPrior::*high;
    const std::vector<double>& axis;
    double unit;
    const char* unit_name;
  };
  for (const Side& side :
       {Side{"depth", &DepthPrior::depth_min, &DepthPrior::depth_max, grid.depths, 1e-3, " mm"},
        Side{"radius", &DepthPrior::radius_min, &DepthPrior::radius_max, grid.radii, 1e-3, " mm"},
        Side{"ratio", &DepthPrior::ratio_min, &DepthPrior::ratio_max, grid.ratios, 1, ""}}) {
    out.*side.low = std::max(out.*side.low, side.axis.front());
    out.*side.high = std::min(out.*side.high, side.axis.back());
    if (out.*side.low <= out.*side.high) continue;
    return fail(
        formatted("no inclusion of the database has a %s of %.6g to %.6g%s, it holds %.6g "
                  "to %.6g%s",
                  side.name,
                  prior.*side.low / side.unit,
                  prior.*side.high / side.unit,
                  side.unit_name,
                  side.axis.front() / side.unit,
                  side.axis.back() / side.unit,
                  side.unit_name));
  }
  return out;
}

CurveTerms curve_polynomials(double indentation) noexcept {
  const double t = 2 * std::clamp(indentation / kCurveReach, 0.0, 1.0) - 1;
  CurveTerms out{1, t};
  for (std::size_t m = 2; m < kCurveTerms; ++m) out[m] = 2 * t * out[m - 1] - out[m - 2];
  return out;
}

/// Lagrange's cubic through the two nodes on each side; at the ends through the last four.
NodeAxis::Weights NodeAxis::at(double x) const noexcept {
  Weights out;
  if (count < 4) {
    out.weight[0] = 1;
    return out;
  }
  const double place = (x - low) / step;
  const double last = static_cast<double>(count - 4);
  const double first = std::clamp(std::floor(place) - 1, 0.0, last);
  out.first = static_cast<std::size_t>(first);
  const double t = place - first;
  out.weight = {-(t - 1) * (t - 2) * (t - 3) / 6,
                t * (t - 2) * (t - 3) / 2,
                -t * (t - 1) * (t - 3) / 2,
                t * (t - 1) * (t - 2) / 6};
  return out;
}

CurveTerms CurveLine::at(double log_depth) const noexcept {
  const NodeAxis::Weights depth = depth_.at(log_depth);
  CurveTerms out{};
  // A depth outside the range is answered with the nearest nodes: finite, and no more.
  const std::size_t last = first_ + count_ - 4;
  const std::size_t from = std::clamp(depth.first, first_, last) - first_;
  for (std::size_t i = 0; i < 4; ++i) add(out, terms_[from + i], depth.weight[i]);
  return out;
}

CurveLattice::CurveLattice(const DepthDatabase& database, const DepthPrior& prior)
    : depth_{log_axis(prior)},
      radius_{axis(prior.radius_min, prior.radius_max, kRadii)},
      effect_{axis(effect_of(prior.ratio_min), effect_of(prior.ratio_max), kEffects)} {
  const Shortening shorten{database};
  terms_.reserve(radius_.count * effect_.count * depth_.count);
  for (std::size_t j = 0; j < radius_.count; ++j) {
    for (std::size_t k = 0; k < effect_.count; ++k) {
      for (std::size_t i = 0; i < depth_.count; ++i) {
        terms_.push_back(shorten(database,
                                 database.curve({.shape = prior.shape,
                                                 .depth = std::exp(depth_.node(i)),
                                                 .radius = radius_.node(j),
                                                 .ratio = ratio_of(effect_.node(k))})));
      }
    }
  }
}

CurveTerms CurveLattice::at(double log_depth, double radius, double effect) const noexcept {
  const NodeAxis::Weights depth = depth_.at(log_depth);
  const NodeAxis::Weights wide = radius_.at(radius);
  const NodeAxis::Weights hard = effect_.at(effect);
  CurveTerms out{};
  for (std::size_t j = 0; j < std::min<std::size_t>(4, radius_.count); ++j) {
    for (std::size_t k = 0; k < std::min<std::size_t>(4, effect_.count); ++k) {
      const std::size_t from =
          ((wide.first + j) * effect_.count + hard.first + k) * depth_.count + depth.first;
      const double weight = wide.weight[j] * hard.weight[k];
      for (std::size_t i = 0; i < 4; ++i) add(out, terms_[from + i], weight * depth.weight[i]);
    }
  }
  return out;
}

CurveLine CurveLattice::line(double radius, double effect, double low, double high) const noexcept {
  CurveLine out;
  out.depth_ = depth_;
  out.first_ = depth_.at(low).first;
  out.count_ = depth_.at(high).first + 4 - out.first_;
  std::fill_n(out.terms_.begin(), out.count_, CurveTerms{});
  const NodeAxis::Weights wide = radius_.at(radius);
  const NodeAxis::Weights hard = effect_.at(effect);
  for (std::size_t j = 0; j < std::min<std::size_t>(4, radius_.count); ++j) {
    for (std::size_t k = 0; k < std::min<std::size_t>(4, effect_.count); ++k) {
      const std::size_t from =
          ((wide.first + j) * effect_.count + hard.first + k) * depth_.count + out.first_;
      const double weight = wide.weight[j] * hard.weight[k];
      for (std::size_t i = 0; i < out.count_; ++i) add(out.terms_[i], terms_[from + i], weight);
    }
  }
  return out;
}

}  // namespace palp::depth
