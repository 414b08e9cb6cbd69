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

constexpr double kSurfaceSpread = 0.3e-3;  // [m], how well the surface is known beforehand
constexpr double kExact = 1e-6;            // of a value known exactly, relative

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
};

/// Loading branch of one tap.
std::vector<Motion> loading(const TapPlan& plan) {
  std::vector<Motion> out;
  LowPass pole{plan.sensor_cut_off, plan.period};
  pole.reset(-plan.clearance);
  const double swing = (plan.indentation + plan.clearance) / 2;
  double before = -plan.clearance;
  for (double t = 0; t < plan.tap_time / 2; t += plan.period) {
    const double tip =
        -plan.clearance + swing * (1 - std::cos(2 * std::numbers::pi * t / plan.tap_time));
    const double at = pole.step(tip);
    if (at > 0) out.push_back({at, (at - before) / plan.period});
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
  using Query = fem::DepthDatabase::Query;
  const auto curve = [&](const Query& query) { return database.curve(query); };
  const double dz = 0.01 * truth.depth;
  const double da = 0.01 * truth.radius;
  const double dk = 0.02;
  const auto shifted = [&](double depth, double radius, double log_ratio) {
    Query query = truth;
    query.depth += depth;
    query.radius += radius;
    query.ratio *= std::exp(log_ratio);
    return curve(query);
  };
  const auto here = curve(truth);
  const std::array low{shifted(-dz, 0, 0), shifted(0, -da, 0), shifted(0, 0, -dk)};
  const std::array high{shifted(dz, 0, 0), shifted(0, da, 0), shifted(0, 0, dk)};
  const std::array<double, 3> step{2 * dz, 2 * da, 2 * dk};
  const auto plain = database.plain();
  const double scale = stiffness.scale;
  Matrix information{};
  Vector signal_right{};
  double signal_squares = 0;
  const auto add = [&](const Vector& x, double weight, double off) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j < kUnknowns; ++j) information[i][j] += weight * x[i] * x[j];
      signal_right[i] += weight * x[i] * off;
    }
    signal_squares += weight * off * off;
  };
  const double ds = 1e-6;  // [m]
  const std::vector<Motion> motion = loading(plan);
  Matrix plain_information{};
  for (const Motion& at : motion) {
    if (at.indentation > std::min(here.indentation_max, 4.05e-3)) continue;
    const auto force = [&](const auto& of, double d) { return database.force(of, d); };
    const double with = force(here, at.indentation);
    const double without = force(plain, at.indentation);
    const double rate = 1 + stiffness.rate_factor * at.rate;
    const auto slope = [&](const auto& of) {
      return (force(of, at.indentation + ds) - force(of, std::max(0.0, at.indentation - ds))) /
             (2 * ds);
    };
    Vector over{};
    for (std::size_t i = 0; i < 3; ++i) {
      over[i] =
          scale * rate * (force(high[i], at.indentation) - force(low[i], at.indentation)) / step[i];
    }
    over[3] = rate * with;
    over[4] = scale * with * at.rate;
    over[5] = -scale * rate * slope(here);
    const double weight =
        plan.taps * sample_information(scale * rate * with, plan.force_noise, plan.force_quantum);
    add(over, weight, 0);
    const Vector beside{
        0, 0, 0, rate * without, scale * without * at.rate, 0, -scale * rate * slope(plain)};
    const double beside_weight =
        plan.reference_taps *
        sample_information(scale * rate * without, plan.force_noise, plan.force_quantum);
    add(beside, beside_weight, 0);
    // As if there were no inclusion: what stiffness, rate and surface cannot explain.
    const Vector blank{
        0, 0, 0, rate * without, scale * without * at.rate, -scale * rate * slope(plain), 0};
    const double off = scale * rate * (with - without);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        plain_information[i][j] +=
            weight * blank[i] * blank[j] + beside_weight * beside[i] * beside[j];
      }
      signal_right[i] += weight * blank[i] * off;
    }
    signal_squares += weight * off * off;
  }
  const Vector known{uniform_information(prior.depth_min, prior.depth_max, truth.depth),
                     uniform_information(prior.radius_min, prior.radius_max, truth.radius),
                     uniform_information(std::log(prior.ratio_min), std::log(prior.ratio_max), 1),
                     1 / (stiffness.scale_stddev * stiffness.scale_stddev),
                     1 / (stiffness.rate_factor_stddev * stiffness.rate_factor_stddev),
                     1 / (kSurfaceSpread * kSurfaceSpread),
                     1 / (kSurfaceSpread * kSurfaceSpread)};
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
