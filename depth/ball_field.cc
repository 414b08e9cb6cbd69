#include "depth/ball_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "depth/quick_exp.h"

namespace palp::depth {
namespace {

constexpr std::size_t kDepthPoints = 12;
constexpr std::size_t kRadiusPoints = 8;
constexpr std::size_t kEffectPoints = 4;
constexpr double kFarthest = 3.2;  // [-], offset over the centre's depth, to which g is tabled
constexpr double kNear = 1e-2;     // [-], the offset that stands for the axis
constexpr double kLeast = 0.5;     // [-], F/F_plain: no ball that is stiffer is below

/// Offsets lie denser near the axis, where the force is.
double offset_point(std::size_t i, std::size_t count) {
  const double part = static_cast<double>(i) / static_cast<double>(count - 1);
  return kFarthest * part * (0.4 + 0.6 * part);
}
/// Where an offset lies between the points.
double offset_place(double offset, std::size_t count) {
  const double part = (-0.4 + std::sqrt(0.16 + 2.4 * offset / kFarthest)) / 1.2;
  return part * static_cast<double>(count - 1);
}

NodeAxis points_between(double low, double high, std::size_t count) {
  if (!(high > low * (1 + 1e-9))) return {.low = low, .step = 0, .count = 1};
  return {.low = low, .step = (high - low) / static_cast<double>(count - 1), .count = count};
}

/// The two points round a value, and the share of the second.
struct Between {
  std::size_t first{};
  double share{};
};
Between between(const NodeAxis& axis, double x) noexcept {
  if (axis.count < 2) return {};
  const double place =
      std::clamp((x - axis.low) / axis.step, 0.0, static_cast<double>(axis.count - 1) - 1e-9);
  const auto first = static_cast<std::size_t>(place);
  return {first, place - static_cast<double>(first)};
}

NodalCurve make_indentations() {
  NodalCurve out{};
  for (std::size_t j = 0; j < kCurveNodes; ++j) {
    const double angle = std::numbers::pi * (static_cast<double>(j) + 0.5) / kCurveNodes;
    out[j] = 0.5 * kCurveReach * (1 - std::cos(angle));
  }
  return out;
}

/// Chebyshev's polynomials are orthogonal over Chebyshev's nodes.
std::array<CurveTerms, kCurveNodes> make_terms() {
  std::array<CurveTerms, kCurveNodes> out{};
  for (std::size_t j = 0; j < kCurveNodes; ++j) {
    out[j] = curve_polynomials(node_indentations()[j]);
    for (std::size_t m = 0; m < kCurveTerms; ++m) out[j][m] *= (m == 0 ? 1.0 : 2.0) / kCurveNodes;
  }
  return out;
}

}  // namespace

const NodalCurve& node_indentations() noexcept {
  static const NodalCurve nodes = make_indentations();
  return nodes;
}

const std::array<CurveTerms, kCurveNodes>& node_terms() noexcept {
  static const std::array<CurveTerms, kCurveNodes> terms = make_terms();
  return terms;
}

LateralShare lateral_share(const DepthDatabase& database) {
  if (!database.solved_beside()) {
    return [](const DepthDatabase::Query& ball, double offset, double) {
      const double s = offset / (ball.depth + ball.radius);
      return std::pow(1 + s * s, -3);
    };
  }
  struct Last {
    DepthDatabase::Query ball;
    LateralShape::OfBall shape;
  };
  return [&database, last = std::optional<Last>{}](
             const DepthDatabase::Query& ball, double offset, double indentation) mutable {
    const bool same = last && last->ball.depth == ball.depth && last->ball.radius == ball.radius &&
                      last->ball.ratio == ball.ratio;
    if (!same) last = Last{ball, database.shape(ball)};
    return database.share(last->shape, offset, indentation);
  };
}

BallField::BallField(const DepthDatabase& database,
                     const DepthPrior& prior,
                     const LateralShare& share)
    : lattice_{database, prior},
      depth_{points_between(lattice_.log_depths().low, lattice_.log_depths().high(), kDepthPoints)},
      radius_{points_between(lattice_.radii().low, lattice_.radii().high(), kRadiusPoints)},
      effect_{points_between(lattice_.effects().low, lattice_.effects().high(), kEffectPoints)} {
  falls_.reserve(radius_.count * effect_.count * depth_.count);
  for (std::size_t j = 0; j < radius_.count; ++j) {
    for (std::size_t k = 0; k < effect_.count; ++k) {
      for (std::size_t i = 0; i < depth_.count; ++i) {
        const DepthDatabase::Query ball{.shape = prior.shape,
                                        .depth = std::exp(depth_.node(i)),
                                        .radius = radius_.node(j),
                                        .ratio = ratio_of(effect_.node(k))};
        auto& fall = falls_.emplace_back();
        for (std::size_t n = 0; n < Ball::kOffsets; ++n) {
          const double s = std::max(kNear, offset_point(n, Ball::kOffsets));
          for (std::size_t m = 0; m < kCurveNodes; ++m) {
            const double left = share(ball, s * (ball.depth + ball.radius), node_indentations()[m]);
            fall[n][m] = -std::log(std::clamp(left, 1e-9, 1.0)) / (s * s);
          }
        }
      }
    }
  }
}

BallField::Ball BallField::at(double log_depth, double radius, double effect) const noexcept {
  Ball out;
  out.centre_ = std::exp(log_depth) + radius;
  const CurveTerms terms = lattice_.at(log_depth, radius, effect);
  static const std::array<CurveTerms, kCurveNodes> polynomials = [] {
    std::array<CurveTerms, kCurveNodes> rows{};
    for (std::size_t m = 0; m < kCurveNodes; ++m) {
      rows[m] = curve_polynomials(node_indentations()[m]);
    }
    return rows;
  }();
  for (std::size_t m = 0; m < kCurveNodes; ++m) {
    double ratio = 0;
    for (std::size_t n = 0; n < kCurveTerms; ++n) ratio += terms[n] * polynomials[m][n];
    out.excess_[m] = std::log(std::max(ratio, kLeast));
  }
  const Between deep = between(depth_, log_depth);
  const Between wide = between(radius_, radius);
  const Between hard = between(effect_, effect);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const bool i = (corner & 1U) != 0;
    const bool j = (corner & 2U) != 0;
    const bool k = (corner & 4U) != 0;
    const double weight = (i ? deep.share : 1 - deep.share) * (j ? wide.share : 1 - wide.share) *
                          (k ? hard.share : 1 - hard.share);
    if (weight == 0) continue;
    const auto& from =
        falls_[((wide.first + (j ? 1 : 0)) * effect_.count + hard.first + (k ? 1 : 0)) *
                   depth_.count +
               deep.first + (i ? 1 : 0)];
    for (std::size_t n = 0; n < Ball::kOffsets; ++n) {
      for (std::size_t m = 0; m < kCurveNodes; ++m) out.fall_[n][m] += weight * from[n][m];
    }
  }
  return out;
}

/// Beyond the last point g falls as the sixth power.
NodalCurve BallField::Ball::ratio(double offset) const noexcept {
  const double s = offset / centre_;
  const double inside = std::min(s, kFarthest);
  const double place =
      std::min(offset_place(inside, kOffsets), static_cast<double>(kOffsets - 1) - 1e-9);
  const auto first = static_cast<std::size_t>(place);
  // Linear in the offset between the points.
  const double low = offset_point(first, kOffsets);
  const double share = (inside - low) / (offset_point(first + 1, kOffsets) - low);
  const double far = s > kFarthest ? std::pow(kFarthest / s, 6) : 1;
  NodalCurve out{};
  for (std::size_t m = 0; m < kCurveNodes; ++m) {
    const double fall = fall_[first][m] + share * (fall_[first + 1][m] - fall_[first][m]);
    out[m] = -fall * inside * inside;
  }
  out = quick_exp(out);
  for (std::size_t m = 0; m < kCurveNodes; ++m) out[m] *= excess_[m] * far;
  return quick_exp(out);
}

}  // namespace palp::depth
