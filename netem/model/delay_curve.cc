#include "netem/model/delay_curve.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palp::netem {
namespace {

/// Above it the gamma is so near to Wilson and Hilferty's cube of a normal that the difference,
/// below 1e-5 of its spread, drowns.
constexpr double kShapeMax = 400;

/// P(a, x), the share of a gamma law of shape `a` below `x`, and 1 - P: by the series, or by
/// Lentz's continued fraction for x > a + 1 (Press et al., Numerical Recipes, 6.2).
struct GammaShare {
  double below{};
  double above{};
  double steepness{};  ///< dP / d log x
};

GammaShare gamma_share(double a, double x) {
  const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < 2000 && term > sum * 1e-16; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    const double below = std::min(sum * factor, 1.0);
    return {below, 1 - below, factor};
  }
  double b = x + 1 - a;
  double c = 1e300;
  double d = 1 / b;
  double h = d;
  for (int n = 1; n < 2000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    const double step = c * d;
    h *= step;
    if (std::abs(step - 1) < 1e-15) break;
  }
  const double above = std::min(factor * h, 1.0);
  return {1 - above, above, factor};
}

/// The quantile of the gamma law of shape `a` and scale 1 where the standard normal is `z`; it lies
/// above `least`. Newton's steps in the logarithms of `x` and of the smaller tail, from Wilson and
/// Hilferty's cube or, where that fails, from the law of small x; bisection where a step would
/// leave what is known.
double gamma_quantile(double a, double z, double least) {
  const double target = normal_cdf(-std::abs(z));
  const double root = 1 - 1 / (9 * a) + z / (3 * std::sqrt(a));
  double low = std::max(least, 1e-300);
  double high = 1e300;
  double x = root > 0.3 ? a * root * root * root
                        : std::exp((std::log(normal_cdf(z)) + std::lgamma(a + 1)) / a);
  x = std::clamp(x, low, high);
  for (int step = 0; step < 1000; ++step) {
    const GammaShare share = gamma_share(a, x);
    const double tail = z < 0 ? share.below : share.above;
    const double excess = z < 0 ? std::log(tail / target) : -std::log(tail / target);
    (excess < 0 ? low : high) = x;
    double next = x * std::exp(-excess * tail / share.steepness);
    if (!(next >= low && next <= high)) next = std::sqrt(low) * std::sqrt(high);
    if (std::abs(next - x) <= 1e-12 * x) return next;
    x = next;
  }
  return x;
}

std::vector<double> as_doubles(const DelayTable& table) {
  return {table.entries.begin(), table.entries.end()};
}

}  // namespace

DelayCurve::DelayCurve(const DelayLaw& law)
    : shape_{law.shape},
      mean_{static_cast<double>(law.mean.count())},
      jitter_{static_cast<double>(law.jitter.count())},
      floor_{law.floor * mean_} {
  switch (shape_) {
    case DelayShape::Normal:
      break;
    case DelayShape::Uniform:
      make_bent();
      break;
    case DelayShape::Pareto:
      make_table(as_doubles(pareto_table()));
      make_bent();
      break;
    case DelayShape::ParetoNormal:
      make_table(as_doubles(paretonormal_table()));
      make_bent();
      break;
    case DelayShape::Table:
      make_table(as_doubles(law.table));
      break;
    case DelayShape::Gamma:
      if (mean_ > 0 && jitter_ > 0) make_gamma();
      break;
    case DelayShape::LogNormal:
      if (mean_ > 0) {
        log_spread_ = std::sqrt(std::log1p(jitter_ / mean_ * (jitter_ / mean_)));
        log_scale_ = std::exp(-0.5 * log_spread_ * log_spread_);
      }
      break;
    case DelayShape::Histogram:
      make_histogram(law.histogram);
      break;
  }
}

double DelayCurve::at_share(double p) const noexcept {
  switch (shape_) {
    case DelayShape::Uniform:
      return 2 * p - 1;
    case DelayShape::Normal:
    case DelayShape::Gamma:
    case DelayShape::LogNormal:
      return at_normal(normal_quantile(p));
    case DelayShape::Histogram: {
      const auto above = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, p);
      const auto cell = static_cast<std::size_t>(above - shares_.begin()) - 1;
      const double width = shares_[cell + 1] - shares_[cell];
      const double part = width > 0 ? (p - shares_[cell]) / width : 0;
      return values_[cell] + part * (values_[cell + 1] - values_[cell]);
    }
    default:
      return values_.size() < 2 ? 0
                                : lerp_at(values_, p * static_cast<double>(values_.size()) - 0.5);
  }
}

double DelayCurve::bent(double z) const noexcept {
  switch (shape_) {
    case DelayShape::Gamma:
      return z;  // without a mean or a spread
    case DelayShape::LogNormal:
      if (log_spread_ <= 0) return z;
      return (log_scale_ * std::exp(log_spread_ * z) - 1) * (mean_ / jitter_);
    default:
      return at_share(normal_cdf(z));
  }
}

/// Shifted and scaled to mean 0 and spread 1, as interpolated between the ranks.
void DelayCurve::make_table(std::vector<double> sorted) {
  std::sort(sorted.begin(), sorted.end());
  values_ = std::move(sorted);
  if (values_.size() < 2) values_.assign(2, 0.0);
  const std::size_t samples = 64 * values_.size();
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const double value = at_share((static_cast<double>(i) + 0.5) / static_cast<double>(samples));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / static_cast<double>(samples);
  const double spread =
      std::sqrt(std::max(squares / static_cast<double>(samples) - mean * mean, 0.0));
  for (double& value : values_) value = spread > 0 ? (value - mean) / spread : 0;
}

void DelayCurve::make_histogram(const DelayHistogram& histogram) {
  const auto& bins = histogram.bins;
  for (const auto& bin : bins) values_.push_back(bin.lower_ms * 1e6);
  values_.push_back(2 * values_.back() - values_[values_.size() - 2]);
  double total = 0;
  for (const auto& bin : bins) total += bin.count;
  double below = 0;
  double squares = 0;
  mean_ = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double share = bins[i].count / total;
    shares_.push_back(below);
    below += share;
    const double left = values_[i];
    const double right = values_[i + 1];
    mean_ += share * (left + right) / 2;
    squares += share * (left * left + left * right + right * right) / 3;
  }
  shares_.push_back(1);
  jitter_ = std::max(std::sqrt(std::max(squares - mean_ * mean_, 0.0)), 1.0);
  for (double& value : values_) value = (value - mean_) / jitter_;
  floor_ *= mean_;
}

void DelayCurve::make_gamma() {
  const double shape = mean_ * mean_ / (jitter_ * jitter_);  // [1]
  const double scale = std::sqrt(shape);                     // mean / jitter [1]
  double quantile = 0;
  for (std::size_t i = 0; i <= kCells; ++i) {
    const double z = kZMax * (2.0 * static_cast<double>(i) / kCells - 1);
    if (shape > kShapeMax) {
      const double root = 1 - 1 / (9 * shape) + z / (3 * scale);
      quantile = shape * std::max(root * root * root, 0.0);
    } else {
      quantile = gamma_quantile(shape, z, quantile);
    }
    bent_.push_back(quantile / scale - scale);
  }
}

/// Of laws without steps, whose values between knots lie within 1e-5 of their spread where all but
/// a few in 10,000 are drawn.
void DelayCurve::make_bent() {
  std::vector<double> knots;
  for (std::size_t i = 0; i <= kCells; ++i) {
    knots.push_back(bent(kZMax * (2.0 * static_cast<double>(i) / kCells - 1)));
  }
  bent_ = std::move(knots);
}

/// The Hermite series of the delay as a function of its normal gives the correlation of two delays
/// as a power series in that of their normals: sum of c_k^2 a^k over sum of c_k^2, k >= 1.
double DelayCurve::normal_correlation(double asked) const {
  if (asked <= 0) return 0;
  if (asked >= 1) return 1;
  // No draw of a normal is so low that it would be lifted: its correlation is the delay's.
  if (shape_ == DelayShape::Normal && mean_ - kZMax * jitter_ > floor_) return asked;
  constexpr std::size_t kOrder = 60;
  constexpr int kParts = 3000;
  constexpr double kWidth = 2 * kZMax / kParts;
  std::vector<double> coefficients(kOrder + 1);
  double squares = 0;
  for (int i = 0; i < kParts; ++i) {
    const double z = -kZMax + (i + 0.5) * kWidth;
    const double weight = std::exp(-0.5 * z * z) * kWidth * 0.39894228040143267794;
    const double value = std::max(mean_ + jitter_ * at_normal(z), floor_) - mean_;
    squares += weight * value * value;
    double before = 0;
    double here = 1;
    for (std::size_t k = 0; k <= kOrder; ++k) {
      coefficients[k] += weight * value * here;
      const auto order = static_cast<double>(k);
      const double next = (z * here - std::sqrt(order) * before) / std::sqrt(order + 1);
      before = here;
      here = next;
    }
  }
  const double variance = squares - coefficients[0] * coefficients[0];
  if (!(variance > 0)) return asked;
  const auto correlation = [&](double a) {
    double power = 1;
    double sum = 0;
    double used = 0;
    for (std::size_t k = 1; k <= kOrder; ++k) {
      power *= a;
      sum += coefficients[k] * coefficients[k] * power;
      used += coefficients[k] * coefficients[k];
    }
    // What the cut series misses belongs to higher powers still.
    return (sum + std::max(variance - used, 0.0) * power * a) / variance;
  };
  double low = 0;
  double high = 1;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    (correlation(middle) < asked ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace palp::netem
