#include "lab/plan/depth_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/core/filters.h"
#include "common/core/random.h"
#include "common/core/small_solver.h"

namespace palp::lab {
namespace {

// depth, radius, log ratio, stiffness, rate factor, surface above the inclusion, surface beside it
constexpr std::size_t kUnknowns = 7;
using Vector = std::array<double, kUnknowns>;
using System = SmallSystem<kUnknowns>;

constexpr double kExact = 1e-6;  // of a value known exactly, relative

/// Information of a uniform prior as a Gaussian of the same variance.
double uniform_information(double low, double high, double value) {
  const double stddev = std::max((high - low) / std::sqrt(12.0), kExact * std::abs(value));
  return 1 / (stddev * stddev);
}

/// The curves at the truth and round it.
class Curves {
 public:
  Curves(const depth::DepthDatabase& database, const depth::DepthDatabase::Query& truth)
      : database_{database}, plain_{database.plain()}, here_{database.curve(truth)} {
    const std::array<double, 3> off{0.01 * truth.depth, 0.01 * truth.radius, 0.02};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto shifted = [&](double by) {
        depth::DepthDatabase::Query query = truth;
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
  [[nodiscard]] double slope(const depth::DepthDatabase::Curve& curve, double d) const {
    constexpr double kStep = 1e-6;  // [m]
    const double low = std::max(0.0, d - kStep);
    return (database_.force(curve, d + kStep) - database_.force(curve, low)) / (d + kStep - low);
  }

  const depth::DepthDatabase& database_;
  depth::DepthDatabase::Curve plain_;
  depth::DepthDatabase::Curve here_;
  std::array<depth::DepthDatabase::Curve, 3> low_;
  std::array<depth::DepthDatabase::Curve, 3> high_;
  std::array<double, 3> step_{};
};

void add(System& to, const Vector& x, double weight) {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) to.matrix[i][j] += weight * x[i] * x[j];
  }
}

/// What the force is at one instant, and how it changes with the unknowns.
struct Response {
  double force{};        ///< [N]
  double plain{};        ///< [N], were there no inclusion
  Vector along{};        ///< of the force
  Vector along_plain{};  ///< of the force without
};

Response respond(const Curves& curves, const depth::StiffnessPrior& stiffness, const TipState& at) {
  Response out{};
  const double d = at.indentation;
  if (!(d > 0)) return out;
  const double rate = 1 + stiffness.rate_factor * at.rate;
  const double scale = stiffness.scale;
  const std::size_t surface = at.over ? 5 : 6;
  const double without = curves.without(d);
  out.plain = scale * rate * without;
  out.along_plain[3] = rate * without;
  out.along_plain[4] = scale * without * at.rate;
  out.along_plain[surface] = -scale * rate * curves.slope_without(d);
  if (!at.over) {
    out.force = out.plain;
    out.along = out.along_plain;
    return out;
  }
  const double with = curves.with(d);
  out.force = scale * rate * with;
  for (std::size_t i = 0; i < 3; ++i) out.along[i] = scale * rate * curves.along(i, d);
  out.along[3] = rate * with;
  out.along[4] = scale * with * at.rate;
  out.along[surface] = -scale * rate * curves.slope_with(d);
  return out;
}

/// The transducer's pole, of everything.
class Pole {
 public:
  explicit Pole(const ForceSensorFacts& sensor)
      : gain_{LowPass{sensor.pole, 1 / sensor.rate}.gain()} {}
  const Response& step(const Response& input) {
    const auto follow = [&](double& value, double before, double now) {
      value += gain_ * (0.5 * (before + now) - value);  // between samples it sees both
    };
    follow(value_.force, before_.force, input.force);
    follow(value_.plain, before_.plain, input.plain);
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      follow(value_.along[i], before_.along[i], input.along[i]);
      follow(value_.along_plain[i], before_.along_plain[i], input.along_plain[i]);
    }
    before_ = input;
    return value_;
  }

 private:
  double gain_;
  Response before_{};
  Response value_{};
};

}  // namespace

std::vector<TipState> motion_of(const TapPlan& plan) {
  std::vector<TipState> out;
  const double swing = (plan.indentation + plan.clearance) / 2;
  const double omega = 2 * std::numbers::pi / plan.tap_time;
  for (int tap = 0; tap < plan.reference_taps + plan.taps; ++tap) {
    const bool last = tap == plan.reference_taps + plan.taps - 1;
    const double samples = (last ? 0.5 : 1) * plan.tap_time * plan.sensor.rate;
    for (int i = 0; i < static_cast<int>(std::ceil(samples)); ++i) {
      const double t = i / plan.sensor.rate;
      out.push_back({.indentation = -plan.clearance + swing * (1 - std::cos(omega * t)),
                     .rate = swing * omega * std::sin(omega * t),
                     .over = tap >= plan.reference_taps});
    }
  }
  return out;
}

double sample_information(double force, double noise, double quantum) {
  if (!(quantum > 0)) return 1 / (noise * noise);
  double sum = 0;
  const double middle = std::round(force / quantum);
  const auto density = [](double z) {
    return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  };
  const int reach = 2 + static_cast<int>(std::ceil(6 * noise / quantum));
  for (int i = -reach; i <= reach; ++i) {
    const double code = middle + i;
    const double low = ((code - 0.5) * quantum - force) / noise;
    const double high = ((code + 0.5) * quantum - force) / noise;
    const double share = normal_cdf(high) - normal_cdf(low);
    if (share < 1e-12) continue;
    const double slope = (density(low) - density(high)) / noise;
    sum += slope * slope / share;
  }
  return sum;
}

DepthBound depth_bound(const depth::DepthDatabase& database,
                       const depth::DepthDatabase::Query& truth,
                       const depth::DepthPrior& prior,
                       const depth::StiffnessPrior& stiffness,
                       const ForceSensorFacts& sensor,
                       std::span<const TipState> motion) {
  const Curves curves{database, truth};
  System information{.matrix = {}, .right = {1}};
  System plain_information;
  double signal_squares = 0;
  Pole pole{sensor};
  for (const TipState& at : motion) {
    const Response& sensed = pole.step(respond(curves, stiffness, at));
    if (!(sensed.force > 0)) continue;
    const double weight = sample_information(sensed.force, sensor.noise, sensor.step);
    add(information, sensed.along, weight);
    // As if there were no inclusion: what stiffness, rate and surface cannot explain.
    add(plain_information, sensed.along_plain, weight);
    const double off = sensed.force - sensed.plain;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      plain_information.right[i] += weight * sensed.along_plain[i] * off;
    }
    signal_squares += weight * off * off;
  }
  constexpr double kSurface = 1 / (depth::kSurfaceSpread * depth::kSurfaceSpread);
  const Vector known{uniform_information(prior.depth_min, prior.depth_max, truth.depth),
                     uniform_information(prior.radius_min, prior.radius_max, truth.radius),
                     uniform_information(std::log(prior.ratio_min), std::log(prior.ratio_max), 1),
                     1 / (stiffness.scale_stddev * stiffness.scale_stddev),
                     1 / (stiffness.rate_factor_stddev * stiffness.rate_factor_stddev),
                     kSurface,
                     kSurface};
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    information.matrix[i][i] += known[i];
    plain_information.matrix[i][i] += known[i];
  }
  DepthBound bound;
  bound.depth_stddev = std::sqrt(std::max(0.0, solve(information).x[0]));
  signal_squares -= solve(plain_information).explained;
  bound.signal = std::sqrt(std::max(0.0, signal_squares));
  return bound;
}

}  // namespace palp::lab
