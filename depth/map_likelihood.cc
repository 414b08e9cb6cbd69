#include "depth/map_likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/median.h"
#include "common/core/small_solver.h"

namespace palp::depth {
namespace {

constexpr std::array kSpreadShares{0.06, 0.3, 1.0};     // of the spread given,
constexpr std::array kSpreadWeights{0.01, 0.04, 0.95};  // [-], so likely
constexpr double kSpreadLeast = 1e-3;                   // [-]
constexpr std::size_t kMiddle = 3;                      // a node: 2.3 mm
constexpr int kTissuePasses = 3;
constexpr double kStepOffset = 10e-6;  // [m], for slopes
constexpr double kStepDepth = 1e-3;    // [-], of the logarithm
constexpr double kStepRadius = 20e-6;  // [m]
constexpr double kStepRatio = 5e-3;    // [-], of the logarithm

double log_mean(const std::array<double, kSpreadWeights.size()>& values) noexcept {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += kSpreadWeights[i] * std::exp(values[i] - most);
  }
  return most + std::log(sum);
}

NodalCurve scaled(const NodalCurve& curve, double factor) noexcept {
  NodalCurve out = curve;
  for (double& value : out) value *= factor;
  return out;
}

NodalCurve product(const NodalCurve& one, const NodalCurve& other) noexcept {
  NodalCurve out = one;
  for (std::size_t n = 0; n < kCurveNodes; ++n) out[n] *= other[n];
  return out;
}

/// Lower triangle and right side, solved in place: the unknown's logarithm of the determinant and
/// what it explains.
template <std::size_t N>
struct Solved {
  double explained{};
  double log_determinant{};
};
template <std::size_t N>
Solved<N> eliminate(std::array<std::array<double, N>, N>& m,
                    std::array<double, N>& y,
                    std::size_t count) noexcept {
  Solved<N> out;
  for (std::size_t r = 0; r < count; ++r) {
    const double pivot = std::max(m[r][r], std::numeric_limits<double>::min());
    const double inverse = 1 / pivot;
    out.explained += y[r] * y[r] * inverse;
    out.log_determinant += std::log(pivot);
    for (std::size_t below = r + 1; below < N; ++below) {
      const double factor = m[below][r] * inverse;
      for (std::size_t k = r + 1; k <= below; ++k) m[below][k] -= factor * m[k][r];
      y[below] -= factor * y[r];
    }
  }
  return out;
}

}  // namespace

MapLikelihood::MapLikelihood(const BallField& field,
                             const TissuePrior& prior,
                             std::vector<PlaceData> places)
    : field_{&field}, prior_{prior}, places_{std::move(places)} {
  // The same sums in the same order, whoever was touched first.
  std::sort(places_.begin(), places_.end(), [](const PlaceData& a, const PlaceData& b) {
    return a.place.x != b.place.x ? a.place.x < b.place.x : a.place.y < b.place.y;
  });
  for (std::size_t i = 0; i < kSpreads; ++i) {
    spreads_[i] = std::max(kSpreadLeast, kSpreadShares[i] * prior.place_spread);
  }
  find_tissue();
  plain_ = log_mean(spread_values([](const PlaceData&) {
    NodalCurve one{};
    one.fill(1);
    return one;
  }));
  find_excess();
}

/// A place's share of the normal equations of what is unknown: `curves` (of the force, the first
/// one the force itself) and the rate factor, last. How much stiffer the place is than the rest has
/// the force as its column, and goes.
template <std::size_t N>
void MapLikelihood::gather(const PlaceData& place,
                           const std::array<NodalCurve, N>& curves,
                           double middle,
                           std::array<Normal<N + 1>, kSpreads>& to) const noexcept {
  constexpr std::size_t kAll = N + 1;
  constexpr std::size_t kRate = PlaceData::kSize - 1;
  std::array<std::array<double, kAll>, kAll> h{};
  std::array<double, kAll> b{};
  for (std::size_t i = 0; i < N; ++i) {
    PlaceData::Row row{};
    for (std::size_t a = 0; a < kCurveNodes; ++a) {
      for (std::size_t k = 0; k < PlaceData::kSize; ++k) {
        row[k] += curves[i][a] * place.information[a][k];
      }
      b[i] += curves[i][a] * place.pull[a];
    }
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = 0;
      for (std::size_t a = 0; a < kCurveNodes; ++a) sum += row[a] * curves[j][a];
      h[i][j] = h[j][i] = sum;
    }
    h[N][i] = h[i][N] = row[kRate];
  }
  h[N][N] = place.information[kRate][kRate];
  b[N] = place.pull[kRate];
  const double square = place.square + h[0][0] - 2 * b[0];
  std::array<double, kAll> gradient{};
  for (std::size_t i = 0; i < kAll; ++i) gradient[i] = b[i] - h[i][0];
  const double model = prior_.model_error * middle;
  for (std::size_t s = 0; s < kSpreads; ++s) {
    const double variance = spreads_[s] * spreads_[s] + model * model;
    const double away = 1 / (h[0][0] + 1 / variance);
    Normal<kAll>& sum = to[s];
    sum.square += square - gradient[0] * gradient[0] * away;
    sum.log_determinant -= std::log(away / variance);
    for (std::size_t i = 0; i < kAll; ++i) {
      const double left = h[i][0] * away;
      sum.right[i] += gradient[i] - left * gradient[0];
      for (std::size_t j = 0; j <= i; ++j) sum.matrix[i][j] += h[i][j] - left * h[j][0];
    }
  }
}

double MapLikelihood::middle_of(const NodalCurve& ratio) noexcept {
  return std::log(ratio[kMiddle]);
}

/// The force where the tissue is as last found, and what its shapes add.
std::array<NodalCurve, MapLikelihood::kTissue - 1> MapLikelihood::columns(
    const NodalCurve& ratio) const noexcept {
  const NodalCurve force = scaled(ratio, scale_);
  std::array<NodalCurve, kTissue - 1> out;
  out[0] = product(force, curve_);
  for (std::size_t m = 0; m < kTissueShapes; ++m) out[m + 1] = product(force, tissue_shapes()[m]);
  return out;
}

void MapLikelihood::add_prior(Normal<kTissue>& to) const noexcept {
  const StiffnessPrior& known = prior_.stiffness;
  std::array<double, kTissue> spread{};
  std::array<double, kTissue> expected{};
  spread[0] = known.scale_stddev / scale_;
  expected[0] = known.scale / scale_ - 1;
  for (std::size_t m = 0; m < kTissueShapes; ++m) {
    spread[m + 1] = kTissueShapeSpread[m];
    expected[m + 1] = -shapes_[m];
  }
  spread[kTissue - 1] = known.rate_factor_stddev;
  for (std::size_t i = 0; i < kTissue; ++i) {
    const double information = 1 / (spread[i] * spread[i]);
    to.matrix[i][i] += information;
    to.right[i] += information * expected[i];
    to.square += information * expected[i] * expected[i];
    to.log_determinant -= std::log(information);
  }
}

template <class Ratio>
auto MapLikelihood::spread_values(const Ratio& ratio) const noexcept
    -> std::array<double, kSpreads> {
  std::array<Normal<kTissue>, kSpreads> sums{};
  for (const PlaceData& place : places_) {
    const NodalCurve force = ratio(place);
    gather(place, columns(force), middle_of(force), sums);
  }
  std::array<double, kSpreads> values{};
  for (std::size_t s = 0; s < kSpreads; ++s) {
    Normal<kTissue>& sum = sums[s];
    add_prior(sum);
    const auto solved = eliminate(sum.matrix, sum.right, kTissue);
    values[s] =
        -0.5 * (sum.square - solved.explained + sum.log_determinant + solved.log_determinant);
  }
  return values;
}

double MapLikelihood::at(const MapBall& ball) const noexcept {
  const BallField::Ball seen =
      field_->at(ball.log_depth, ball.radius, effect_of(std::exp(ball.log_ratio)));
  return log_mean(spread_values(
      [&](const PlaceData& place) { return seen.ratio(distance(place.place, ball.place)); }));
}

/// All places' normal equations, the tissue's unknowns first (the rate factor last of all).
auto MapLikelihood::gather_around(const MapBall& ball) const noexcept
    -> std::array<Normal<kTissue + kBallCoordinates>, kSpreads> {
  constexpr std::size_t kCurves = kTissue - 1 + kBallCoordinates;
  const auto seen = [&](double depth, double radius, double ratio) {
    return field_->at(
        ball.log_depth + depth, ball.radius + radius, effect_of(std::exp(ball.log_ratio + ratio)));
  };
  const BallField::Ball here = seen(0, 0, 0);
  const std::array<BallField::Ball, 3> beside{
      seen(kStepDepth, 0, 0), seen(0, -kStepRadius, 0), seen(0, 0, -kStepRatio)};
  constexpr std::array kSteps{kStepDepth, -kStepRadius, -kStepRatio};
  std::array<Normal<kCurves + 1>, kSpreads> sums{};
  for (const PlaceData& place : places_) {
    const double offset = distance(place.place, ball.place);
    const NodalCurve ratio = here.ratio(offset);
    const auto tissue = columns(ratio);
    std::array<NodalCurve, kCurves> curves{};
    std::copy(tissue.begin(), tissue.end(), curves.begin());
    const auto slope = [&](const NodalCurve& other, double step) {
      NodalCurve out{};
      for (std::size_t n = 0; n < kCurveNodes; ++n) {
        out[n] = tissue[0][n] * (other[n] / ratio[n] - 1) / step;
      }
      return out;
    };
    const NodalCurve outward = slope(here.ratio(offset + kStepOffset), kStepOffset);
    const double share = offset > 0 ? 1 / offset : 0;
    curves[kTissue - 1] = scaled(outward, share * (ball.place.x - place.place.x));
    curves[kTissue] = scaled(outward, share * (ball.place.y - place.place.y));
    for (std::size_t i = 0; i < 3; ++i) {
      curves[kTissue + 1 + i] = slope(beside[i].ratio(offset), kSteps[i]);
    }
    gather(place, curves, middle_of(ratio), sums);
  }
  return sums;
}

MapLikelihood::Local MapLikelihood::around(const MapBall& ball) const noexcept {
  constexpr std::size_t kCurves = kTissue - 1 + kBallCoordinates;
  constexpr std::size_t kAll = kCurves + 1;
  auto sums = gather_around(ball);
  std::array<double, kSpreads> values{};
  std::array<Local, kSpreads> locals{};
  for (std::size_t s = 0; s < kSpreads; ++s) {
    // The tissue's unknowns first: they are eliminated, the ball's stay.
    constexpr auto kOrder = [] {
      std::array<std::size_t, kAll> order{};
      std::size_t next = 0;
      for (std::size_t i = 0; i < kTissue - 1; ++i) order[next++] = i;
      order[next++] = kAll - 1;
      for (std::size_t i = kTissue - 1; i < kCurves; ++i) order[next++] = i;
      return order;
    }();
    Normal<kTissue> prior;
    add_prior(prior);
    Normal<kAll>& sum = sums[s];
    std::array<std::array<double, kAll>, kAll> matrix{};
    std::array<double, kAll> right{};
    for (std::size_t i = 0; i < kAll; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const std::size_t a = std::max(kOrder[i], kOrder[j]);
        const std::size_t b = std::min(kOrder[i], kOrder[j]);
        matrix[i][j] = sum.matrix[a][b];
      }
      right[i] = sum.right[kOrder[i]];
      if (i >= kTissue) continue;
      matrix[i][i] += prior.matrix[i][i];
      right[i] += prior.right[i];
    }
    const auto solved = eliminate(matrix, right, kTissue);
    values[s] = -0.5 * (sum.square + prior.square - solved.explained + sum.log_determinant +
                        prior.log_determinant + solved.log_determinant);
    for (std::size_t i = 0; i < kBallCoordinates; ++i) {
      locals[s].slope[i] = right[kTissue + i];
      for (std::size_t j = 0; j <= i; ++j) {
        locals[s].information[i][j] = locals[s].information[j][i] =
            matrix[kTissue + i][kTissue + j];
      }
    }
  }
  Local out;
  out.value = log_mean(values);
  for (std::size_t s = 0; s < kSpreads; ++s) {
    const double share = kSpreadWeights[s] * std::exp(values[s] - out.value);
    for (std::size_t i = 0; i < kBallCoordinates; ++i) {
      out.slope[i] += share * locals[s].slope[i];
      for (std::size_t j = 0; j < kBallCoordinates; ++j) {
        out.information[i][j] += share * locals[s].information[i][j];
      }
    }
  }
  return out;
}

/// From the softer half of the places: an inclusion only makes stiffer.
void MapLikelihood::find_tissue() {
  curve_.fill(1);
  std::vector<double> scales;
  for (const PlaceData& place : places_) scales.push_back(place.scale);
  const double typical = median(scales).value_or(1);
  scale_ = typical > 0 ? typical : 1;
  for (int pass = 0; pass < kTissuePasses; ++pass) {
    NodalCurve one{};
    one.fill(1);
    std::array<Normal<kTissue>, kSpreads> sums{};
    for (const PlaceData& place : places_) {
      if (place.scale <= typical) gather(place, columns(one), 0, sums);
    }
    Normal<kTissue>& sum = sums.back();
    add_prior(sum);
    SmallSystem<kTissue> system{.matrix = sum.matrix, .right = sum.right};
    const auto solution = solve(system);
    if (!solution.regular) return;
    for (std::size_t m = 0; m < kTissueShapes; ++m) shapes_[m] += solution.x[m + 1];
    NodalCurve curve = one;
    for (std::size_t n = 0; n < kCurveNodes; ++n) {
      for (std::size_t m = 0; m < kTissueShapes; ++m) {
        curve[n] += shapes_[m] * tissue_shapes()[m][n];
      }
    }
    scale_ *= 1 + solution.x[0];
    curve_ = curve;
  }
}

void MapLikelihood::find_excess() {
  NodalCurve one{};
  one.fill(1);
  const NodalCurve force = columns(one)[0];
  for (const PlaceData& place : places_) {
    double information = 0;
    double pull = 0;
    for (std::size_t a = 0; a < kCurveNodes; ++a) {
      for (std::size_t b = 0; b < kCurveNodes; ++b) {
        information += force[a] * place.information[a][b] * force[b];
      }
      pull += force[a] * place.pull[a];
    }
    const double ratio = pull / information;
    excess_.push_back({.value = std::log(std::max(ratio, 0.1)),
                       .stddev = std::hypot(1 / std::sqrt(information), spreads_.back())});
  }
}

MapLikelihood::Rest MapLikelihood::rest(const MapBall* ball) const {
  const auto ratio = [&](const PlaceData& place) {
    NodalCurve one{};
    one.fill(1);
    if (ball == nullptr) return one;
    return field_->at(ball->log_depth, ball->radius, effect_of(std::exp(ball->log_ratio)))
        .ratio(distance(place.place, ball->place));
  };
  const auto values = spread_values(ratio);
  const auto likeliest =
      static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  std::array<Normal<kTissue>, kSpreads> sums{};
  for (const PlaceData& place : places_) {
    const NodalCurve force = ratio(place);
    gather(place, columns(force), middle_of(force), sums);
  }
  Normal<kTissue>& sum = sums[likeliest];
  add_prior(sum);
  const auto solution = solve(SmallSystem<kTissue>{.matrix = sum.matrix, .right = sum.right});
  Rest out;
  out.scale = scale_ * (1 + solution.x[0]);
  out.rate_factor = prior_.stiffness.rate_factor + solution.x[kTissue - 1];
  out.spread = spreads_[likeliest];
  for (const PlaceData& place : places_) {
    const NodalCurve seen = ratio(place);
    const auto curves = columns(seen);
    NodalCurve force{};
    for (std::size_t n = 0; n < kCurveNodes; ++n) {
      force[n] = curves[0][n] * (1 + solution.x[0]);
      for (std::size_t m = 0; m < kTissueShapes; ++m)
        force[n] += solution.x[m + 1] * curves[m + 1][n];
    }
    double information = 0;
    double pull = 0;
    for (std::size_t a = 0; a < kCurveNodes; ++a) {
      double row = solution.x[kTissue - 1] * place.information[a][PlaceData::kSize - 1];
      for (std::size_t b = 0; b < kCurveNodes; ++b) row += place.information[a][b] * force[b];
      pull += force[a] * (place.pull[a] - row);
      for (std::size_t b = 0; b < kCurveNodes; ++b) {
        information += force[a] * place.information[a][b] * force[b];
      }
    }
    const double model = prior_.model_error * middle_of(seen);
    out.deviations.push_back(pull / information /
                             std::sqrt(1 / information + out.spread * out.spread + model * model));
  }
  return out;
}

}  // namespace palp::depth
