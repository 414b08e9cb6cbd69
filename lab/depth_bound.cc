#include "lab/depth_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/core/filters.h"
#include "common/core/random.h"

namespace palp::lab {
namespace {

// depth, radius, log ratio, stiffness, rate factor, surface above the inclusion, surface beside it
constexpr std::size_t kUnknowns = 7;
using Vector = std::array<double, kUnknowns>;
using Matrix = std::array<Vector, kUnknowns>;

constexpr double kExact = 1e-6;  // of a value known exactly, relative

/// Solves m x = v for a symmetric positive matrix by elimination.
Vector solve(Matrix m, Vector v) {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = i + 1; j < kUnknowns; ++j) {
      const double factor = m[j][i] / m[i][i];
      for (std::size_t k = i; k < kUnknowns; ++k) m[j][k] -= factor * m[i][k];
      v[j] -= factor * v[i];
    }
  }
  for (std::size_t i = kUnknowns; i-- > 0;) {
    for (std::size_t k = i + 1; k < kUnknowns; ++k) v[i] -= m[i][k] * v[k];
    v[i] /= m[i][i];
  }
  return v;
}

/// Information of a uniform prior as a Gaussian of the same variance.
double uniform_information(double low, double high, double value) {
  const double stddev = std::max((high - low) / std::sqrt(12.0), kExact * std::abs(value));
  return 1 / (stddev * stddev);
}

struct Motion {
  double indentation{};  ///< [m], behind the sensor's pole
  double rate{};         ///< [m/s]
  bool loading{};
};

/// The curves at the truth and round it.
class Curves {
 public:
  Curves(const fem::DepthDatabase& database, const fem::DepthDatabase::Query& truth)
      : database_{database}, plain_{database.plain()}, here_{database.curve(truth)} {
    const std::array<double, 3> off{0.01 * truth.depth, 0.01 * truth.radius, 0.02};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto shifted = [&](double by) {
        fem::DepthDatabase::Query query = truth;
        if (i == 0) query.depth += by;
        if (i == 1) query.radius += by;
        if (i == 2) query.ratio *= std::exp(by);
        return database.curve(query);
      };
      low_[i] = shifted(-off[i]);
      high_[i] = shifted(off[i]);
      step_[i] = 2 * off[i];
    }
  }
  [[nodiscard]] double deepest() const { return here_.indentation_max; }  ///< [m]
  [[nodiscard]] double with(double d) const { return database_.force(here_, d); }
  [[nodiscard]] double without(double d) const { return database_.force(plain_, d); }
  [[nodiscard]] double slope_with(double d) const { return slope(here_, d); }
  [[nodiscard]] double slope_without(double d) const { return slope(plain_, d); }
  /// By depth, radius, log ratio.
  [[nodiscard]] double along(std::size_t i, double d) const {
    return (database_.force(high_[i], d) - database_.force(low_[i], d)) / step_[i];
  }

 private:
  [[nodiscard]] double slope(const fem::DepthDatabase::Curve& curve, double d) const {
    constexpr double kStep = 1e-6;  // [m]
    const double low = std::max(0.0, d - kStep);
    return (database_.force(curve, d + kStep) - database_.force(curve, low)) / (d + kStep - low);
  }

  const fem::DepthDatabase& database_;
  fem::DepthDatabase::Curve plain_;
  fem::DepthDatabase::Curve here_;
  std::array<fem::DepthDatabase::Curve, 3> low_;
  std::array<fem::DepthDatabase::Curve, 3> high_;
  std::array<double, 3> step_{};
};

void add(Matrix& to, const Vector& x, double weight) {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j < kUnknowns; ++j) to[i][j] += weight * x[i] * x[j];
  }
}

/// One tap, in the tissue.
std::vector<Motion> motion_of(const TapPlan& plan) {
  std::vector<Motion> out;
  LowPass pole{plan.sensor_cut_off, plan.period};
  pole.reset(-plan.clearance);
  const double swing = (plan.indentation + plan.clearance) / 2;
  double before = -plan.clearance;
  for (double t = 0; t < plan.tap_time; t += plan.period) {
    const double tip =
        -plan.clearance + swing * (1 - std::cos(2 * std::numbers::pi * t / plan.tap_time));
    const double at = pole.step(tip);
    if (at > 0) out.push_back({at, (at - before) / plan.period, t < plan.tap_time / 2});
    before = at;
  }
  return out;
}

}  // namespace

double sample_information(double force, double noise, double quantum) {
  if (!(quantum > 0)) return 1 / (noise * noise);
  double sum = 0;
  const double middle = std::round(force / quantum);
  const auto density = [](double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  };
  const double reach = 2 + std::ceil(6 * noise / quantum);
  for (double code = middle - reach; code <= middle + reach; ++code) {
    const double low = ((code - 0.5) * quantum - force) / noise;
    const double high = ((code + 0.5) * quantum - force) / noise;
    const double share = normal_cdf(high) - normal_cdf(low);
    if (share < 1e-12) continue;
    const double slope = (density(low) - density(high)) / noise;
    sum += slope * slope / share;
  }
  return sum;
}

DepthBound depth_bound(const fem::DepthDatabase& database,
                       const fem::DepthDatabase::Query& truth,
                       const estimator::DepthPrior& prior,
                       const estimator::StiffnessPrior& stiffness,
                       const TapPlan& plan) {
  const Curves curves{database, truth};
  const double scale = stiffness.scale;
  Matrix information{};
  Matrix plain_information{};
  Vector signal_right{};
  double signal_squares = 0;
  for (const Motion& at : motion_of(plan)) {
    const double d = at.indentation;
    if (d > std::min(curves.deepest(), estimator::kDeepestPoint)) continue;
    const double with = curves.with(d);
    const double without = curves.without(d);
    const double rate = 1 + stiffness.rate_factor * at.rate;
    const auto weight = [&](int strokes, double force) {
      return strokes * sample_information(force, plan.force_noise, plan.force_quantum);
    };
    // The answer is there at the last reversal: of that tap the way back is still to come.
    const int strokes = at.loading ? plan.taps : plan.taps - 1;
    const double weight_over = weight(strokes, scale * rate * with);
    const double weight_beside = weight(plan.reference_taps, scale * rate * without);
    Vector over{0, 0, 0, rate * with, scale * with * at.rate, -scale * rate * curves.slope_with(d)};
    for (std::size_t i = 0; i < 3; ++i) over[i] = scale * rate * curves.along(i, d);
    const double slope = -scale * rate * curves.slope_without(d);
    const Vector beside{0, 0, 0, rate * without, scale * without * at.rate, 0, slope};
    // As if there were no inclusion: what stiffness, rate and surface cannot explain.
    const Vector blank{0, 0, 0, rate * without, scale * without * at.rate, slope, 0};
    add(information, over, weight_over);
    add(information, beside, weight_beside);
    add(plain_information, blank, weight_over);
    add(plain_information, beside, weight_beside);
    const double off = scale * rate * (with - without);
    for (std::size_t i = 0; i < kUnknowns; ++i) signal_right[i] += weight_over * blank[i] * off;
    signal_squares += weight_over * off * off;
  }
  const Vector known{uniform_information(prior.depth_min, prior.depth_max, truth.depth),
                     uniform_information(prior.radius_min, prior.radius_max, truth.radius),
                     uniform_information(std::log(prior.ratio_min), std::log(prior.ratio_max), 1),
                     1 / (stiffness.scale_stddev * stiffness.scale_stddev),
                     1 / (stiffness.rate_factor_stddev * stiffness.rate_factor_stddev),
                     1 / (estimator::kSurfaceSpread * estimator::kSurfaceSpread),
                     1 / (estimator::kSurfaceSpread * estimator::kSurfaceSpread)};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    information[i][i] += known[i];
    plain_information[i][i] += known[i];
  }
  DepthBound bound;
  bound.depth_stddev = std::sqrt(std::max(0.0, solve(information, {1})[0]));
  const Vector explained = solve(plain_information, signal_right);
  for (std::size_t i = 0; i < kUnknowns; ++i) signal_squares -= explained[i] * signal_right[i];
  bound.signal = std::sqrt(std::max(0.0, signal_squares));
  return bound;
}

}  // namespace palp::lab
