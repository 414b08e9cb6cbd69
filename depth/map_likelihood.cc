#include "depth/map_likelihood.h"

#include <algorithm>
#include <cmath>

#include "common/core/median.h"
#include "common/core/small_solver.h"
#include "depth/elimination.h"

namespace palp::depth {
namespace {

constexpr int kTissuePasses = 3;
constexpr double kStepOffset = 10e-6;  // [m], for slopes
constexpr double kStepDepth = 1e-3;    // [-], of the logarithm
constexpr double kStepRadius = 20e-6;  // [m]
constexpr double kStepRatio = 5e-3;    // [-], of the logarithm

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

constexpr NodalCurve kOnes = [] {
  NodalCurve ones{};
  ones.fill(1);
  return ones;
}();

}  // namespace

MapLikelihood::MapLikelihood(const BallField& field,
                             const TissuePrior& prior,
                             std::vector<PlaceData> places)
    : field_{&field}, prior_{prior}, places_{std::move(places)} {
  // The same sums in the same order, whoever was touched first.
  std::sort(places_.begin(), places_.end(), [](const PlaceData& a, const PlaceData& b) {
    return a.place.x != b.place.x ? a.place.x < b.place.x : a.place.y < b.place.y;
  });
  std::vector<Place> touched;
  for (const PlaceData& one : places_) touched.push_back(one.place);
  differs_ = StiffnessField{std::move(touched), prior.place_spread};
  find_tissue();
  const auto gathered = gather_all([](const PlaceData&) { return kOnes; });
  plain_ = mean_of(values_of(gathered, whiten(differs_, gathered)));
  find_excess();
}

/// A place's share of the normal equations of what is unknown: `curves` (of the force, the first
/// one the force itself) and the rate factor, last. How much stiffer the place is than the rest has
/// the force as its column. What the place says of that goes into a row, and what is left of the
/// equations says nothing of it.
template <std::size_t N>
void MapLikelihood::gather(const PlaceData& place,
                           const std::array<NodalCurve, N>& curves,
                           double middle,
                           Gathered<N + 1>& to) const {
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
  std::array<double, kAll> gradient{};
  for (std::size_t i = 0; i < kAll; ++i) gradient[i] = b[i] - h[i][0];
  const double noise = 1 / h[0][0];  // of its stiffness, relative
  const double model = prior_.model_error * middle;
  to.own.push_back(noise + model * model);
  Normal<kAll>& sum = to.equations;
  sum.square += place.square + h[0][0] - 2 * b[0] - gradient[0] * gradient[0] * noise;
  sum.log_determinant -= std::log(noise);
  for (std::size_t i = 0; i < kAll; ++i) {
    const double left = h[i][0] * noise;
    to.rows.push_back(left);
    sum.right[i] += gradient[i] - left * gradient[0];
    for (std::size_t j = 0; j <= i; ++j) sum.matrix[i][j] += h[i][j] - left * h[j][0];
  }
  to.rows.push_back(gradient[0] * noise);
}

/// The normal equations where the places' own stiffness is integrated out.
template <std::size_t N>
auto MapLikelihood::under(std::size_t guess,
                          const Gathered<N>& gathered,
                          const StiffnessField::Whitened& whitened) -> Normal<N> {
  Normal<N> out = gathered.equations;
  out.log_determinant += whitened.log_determinant[guess];
  const std::span<const double> rows = whitened.of(guess);
  for (std::size_t at = 0; at < rows.size(); at += N + 1) {
    const double* row = &rows[at];
    for (std::size_t i = 0; i < N; ++i) {
      out.right[i] += row[i] * row[N];
      for (std::size_t j = 0; j <= i; ++j) out.matrix[i][j] += row[i] * row[j];
    }
    out.square += row[N] * row[N];
  }
  return out;
}

double MapLikelihood::middle_of(const NodalCurve& ratio) noexcept {
  return std::log(ratio[kMiddleNode]);
}

/// The force where the tissue is as last found, and what its shapes add.
std::array<NodalCurve, MapLikelihood::kTissue - 1> MapLikelihood::columns(
    const NodalCurve& ratio) const noexcept {
  const NodalCurve force = scaled(ratio, scale_);
  std::array<NodalCurve, kTissue - 1> out{};
  out[0] = product(force, curve_);
  for (std::size_t m = 0; m < kTissueShapes; ++m) out[m + 1] = product(force, tissue_shapes()[m]);
  return out;
}

void MapLikelihood::add_prior(Normal<kTissue>& to) const noexcept {
  const StiffnessPrior& known = prior_.stiffness;
  std::array<double, kTissue> spread{};
  std::array<double, kTissue> expected{};
  spread[0] = kModulusSpread * known.scale / scale_;
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
auto MapLikelihood::gather_all(const Ratio& ratio) const -> Gathered<kTissue> {
  Gathered<kTissue> out;
  for (const PlaceData& place : places_) {
    const NodalCurve seen = ratio(place);
    gather(place, columns(seen), middle_of(seen), out);
  }
  return out;
}

/// By guess of the field.
auto MapLikelihood::values_of(const Gathered<kTissue>& gathered,
                              const StiffnessField::Whitened& whitened) const -> ByGuess {
  ByGuess values{};
  for (std::size_t guess = 0; guess < values.size(); ++guess) {
    Normal<kTissue> sum = under(guess, gathered, whitened);
    add_prior(sum);
    const auto solved = eliminate(sum.matrix, sum.right, kTissue);
    values[guess] =
        -0.5 * (sum.square - solved.explained + sum.log_determinant + solved.log_determinant);
  }
  return values;
}

double MapLikelihood::mean_of(const ByGuess& values) const noexcept {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0;
  for (std::size_t guess = 0; guess < values.size(); ++guess) {
    sum += differs_.guess(guess).share * std::exp(values[guess] - most);
  }
  return most + std::log(sum);
}

auto MapLikelihood::values_at(const MapBall& ball) const -> ByGuess {
  const BallField::Ball seen =
      field_->at(ball.log_depth, ball.radius, effect_of(std::exp(ball.log_ratio)));
  const auto gathered = gather_all(
      [&](const PlaceData& place) { return seen.ratio(distance(place.place, ball.place)); });
  return values_of(gathered, whiten(differs_, gathered));
}

double MapLikelihood::at(const MapBall& ball) const { return mean_of(values_at(ball)); }

StiffnessField::ByGuess MapLikelihood::guesses(const MapBall& ball) const {
  ByGuess out = values_at(ball);
  const double all = mean_of(out);
  for (std::size_t guess = 0; guess < out.size(); ++guess) {
    out[guess] = differs_.guess(guess).share * std::exp(out[guess] - all);
  }
  return out;
}

/// All places' normal equations, the tissue's unknowns first (the rate factor last of all).
auto MapLikelihood::gather_around(const MapBall& ball) const
    -> Gathered<kTissue + kBallCoordinates> {
  constexpr std::size_t kCurves = kTissue - 1 + kBallCoordinates;
  const auto seen = [&](double depth, double radius, double ratio) {
    return field_->at(
        ball.log_depth + depth, ball.radius + radius, effect_of(std::exp(ball.log_ratio + ratio)));
  };
  const BallField::Ball here = seen(0, 0, 0);
  const std::array<BallField::Ball, 3> beside{
      seen(kStepDepth, 0, 0), seen(0, -kStepRadius, 0), seen(0, 0, -kStepRatio)};
  constexpr std::array kSteps{kStepDepth, -kStepRadius, -kStepRatio};
  Gathered<kCurves + 1> all;
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
    gather(place, curves, middle_of(ratio), all);
  }
  return all;
}

MapLikelihood::Local MapLikelihood::around(const MapBall& ball) const {
  constexpr std::size_t kCurves = kTissue - 1 + kBallCoordinates;
  constexpr std::size_t kAll = kCurves + 1;
  const Gathered<kAll> gathered = gather_around(ball);
  const auto whitened = whiten(differs_, gathered);
  ByGuess values{};
  std::array<Local, StiffnessField::kGuesses> locals{};
  for (std::size_t s = 0; s < values.size(); ++s) {
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
    const Normal<kAll> sum = under(s, gathered, whitened);
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
  out.value = mean_of(values);
  for (std::size_t s = 0; s < values.size(); ++s) {
    const double share = differs_.guess(s).share * std::exp(values[s] - out.value);
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
  std::vector<PlaceData> soft;
  std::vector<Place> touched;
  for (const PlaceData& place : places_) {
    if (place.scale > typical) continue;
    soft.push_back(place);
    touched.push_back(place.place);
  }
  const StiffnessField differs{std::move(touched), prior_.place_spread};
  for (int pass = 0; pass < kTissuePasses; ++pass) {
    Gathered<kTissue> gathered;
    for (const PlaceData& place : soft) gather(place, columns(kOnes), 0, gathered);
    Normal<kTissue> sum = under(StiffnessField::kIndependent, gathered, whiten(differs, gathered));
    add_prior(sum);
    SmallSystem<kTissue> system{.matrix = sum.matrix, .right = sum.right};
    const auto solution = solve(system);
    if (!solution.regular) return;
    for (std::size_t m = 0; m < kTissueShapes; ++m) shapes_[m] += solution.x[m + 1];
    NodalCurve curve = kOnes;
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
  const NodalCurve force = columns(kOnes)[0];
  for (const PlaceData& place : places_) {
    const FactorTold told = factor_told(place, force, 0);
    const double ratio = told.pull / told.information;
    excess_.push_back({.value = std::log(std::max(ratio, 0.1)),
                       .stddev = std::hypot(1 / std::sqrt(told.information), prior_.place_spread)});
  }
}

MapLikelihood::Rest MapLikelihood::rest(const MapBall* ball) const {
  const auto ratio = [&](const PlaceData& place) {
    if (ball == nullptr) return kOnes;
    return field_->at(ball->log_depth, ball->radius, effect_of(std::exp(ball->log_ratio)))
        .ratio(distance(place.place, ball->place));
  };
  Gathered<kTissue> gathered = gather_all(ratio);
  const auto whitened = whiten(differs_, gathered);
  const auto values = values_of(gathered, whitened);
  Rest out;
  out.guess =
      static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  Normal<kTissue> sum = under(out.guess, gathered, whitened);
  add_prior(sum);
  const auto solution = solve(SmallSystem<kTissue>{.matrix = sum.matrix, .right = sum.right});
  out.scale = scale_ * (1 + solution.x[0]);
  out.rate_factor = prior_.stiffness.rate_factor + solution.x[kTissue - 1];
  out.spread = differs_.guess(out.guess).spread;
  out.own = std::move(gathered.own);
  for (const PlaceData& place : places_) {
    const NodalCurve seen = ratio(place);
    const auto curves = columns(seen);
    NodalCurve force{};
    for (std::size_t n = 0; n < kCurveNodes; ++n) {
      force[n] = curves[0][n] * (1 + solution.x[0]);
      for (std::size_t m = 0; m < kTissueShapes; ++m)
        force[n] += solution.x[m + 1] * curves[m + 1][n];
    }
    const FactorTold told = factor_told(place, force, solution.x[kTissue - 1]);
    out.shown.push_back(told.pull / told.information - 1);
    const double all = out.own[out.shown.size() - 1] + out.spread * out.spread;
    out.deviations.push_back(out.shown.back() / std::sqrt(all));
  }
  return out;
}

}  // namespace palp::depth
