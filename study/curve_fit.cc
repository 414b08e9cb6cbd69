#include "study/curve_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kNormalWidth = 3.28970725390294;     // from 5 to 95 % of the normal distribution
constexpr double kLogisticWidth = 5.88887795833288;   // 2 ln 19
constexpr double kWeibullLow = -2.97019524904606;     // ln(-ln 0.95)
constexpr double kWeibullHigh = 1.09718870058115;     // ln(-ln 0.05)
constexpr double kWeibullMiddle = -0.36651292058166;  // ln(-ln 0.5)
constexpr double kLeast = 1e-12;                      // no share is 0 or 1 in a logarithm
constexpr std::size_t kParameters = 5;
constexpr double kNever = -std::numeric_limits<double>::infinity();

using Point = std::array<double, kParameters>;

CurveParameters parameters_of(const Point& point) {
  return {point[0], point[1], point[2], point[3], point[4]};
}

/// Sum of the logarithms of from, from + 1, ..., count terms: in products, which are cheaper.
double log_rising(double from, std::size_t count) noexcept {
  double sum = 0;
  double product = 1;
  for (std::size_t i = 0; i < count; ++i) {
    product *= from + static_cast<double>(i);
    if (product > 1e200 || product < 1e-200) {
      sum += std::log(product);
      product = 1;
    }
  }
  return sum + std::log(product);
}

double log_of_share(double share, const Answers& at, double dispersion) noexcept {
  share = std::clamp(share, kLeast, 1 - kLeast);
  const std::size_t no = at.trials - at.yes;
  if (dispersion * dispersion < 1e-9) {
    return static_cast<double>(at.yes) * std::log(share) +
           static_cast<double>(no) * std::log1p(-share);
  }
  const double strength = 1 / (dispersion * dispersion) - 1;
  return log_rising(share * strength, at.yes) + log_rising((1 - share) * strength, no) -
         log_rising(strength, at.trials);
}

/// 1 between `low` and `high`, a cosine down to 0 at `below` and `above`.
double even_between(double x, double below, double low, double high, double above) {
  if (x <= below || x >= above) return 0;
  if (x < low) return 0.5 + 0.5 * std::cos(std::numbers::pi * (low - x) / (low - below));
  if (x > high) return 0.5 + 0.5 * std::cos(std::numbers::pi * (x - high) / (above - high));
  return 1;
}

/// Where parameters may be, and what is believed of them.
class Beliefs {
 public:
  Beliefs(std::span<const Answers> answers, const CurveFitOptions& options) : options_{options} {
    const auto place = [&](double level) {
      return options.shape == CurveShape::Weibull ? std::log(level) : level;
    };
    first_ = place(answers.front().level);
    range_ = place(answers.back().level) - first_;
    nearest_ = range_;
    for (std::size_t i = 1; i < answers.size(); ++i) {
      nearest_ = std::min(nearest_, place(answers[i].level) - place(answers[i - 1].level));
    }
  }

  [[nodiscard]] double log_prior(const Point& point) const {
    const double threshold = options_.shape == CurveShape::Weibull ? std::log(point[0]) : point[0];
    double prior =
        even_between(
            threshold, first_ - range_ / 2, first_, first_ + range_, first_ + 1.5 * range_) *
        even_between(point[1], nearest_, 2 * nearest_, std::max(range_, 2 * nearest_), 3 * range_);
    for (std::size_t i = 2; i < kParameters; ++i) {
      if (!free(i)) continue;
      if (point[i] < 0 || point[i] > 1) return kNever;
      prior *= std::pow(1 - point[i], 9);
    }
    return point[2] + point[3] < 1 ? std::log(prior) : kNever;
  }

  [[nodiscard]] bool free(std::size_t parameter) const {
    if (parameter == 3) return options_.intervals == 1;
    return parameter != 4 || options_.overdispersed;
  }

  /// Ends of the first grid.
  [[nodiscard]] std::array<double, 2> ends(std::size_t parameter) const {
    switch (parameter) {
      case 0: {
        const std::array ends{first_ - range_ / 2, first_ + 1.5 * range_};
        if (options_.shape != CurveShape::Weibull) return ends;
        return {std::exp(ends[0]), std::exp(ends[1])};
      }
      case 1:
        return {nearest_, 3 * range_};
      case 3: {
        if (free(3)) return {0, 0.5};
        const double guess = 1.0 / options_.intervals;
        return {guess, guess};
      }
      case 4:
        return {0, free(4) ? 0.9 : 0.0};
      default:
        return {0, 0.5};
    }
  }

 private:
  CurveFitOptions options_;
  double first_{};    // [-], place of the lowest level
  double range_{};    // [-]
  double nearest_{};  // [-], least distance of two levels
};

/// The posterior at every point of a grid. The first coordinate runs slowest.
struct Grid {
  std::array<std::vector<double>, kParameters> axes;
  std::vector<double> weights;  ///< sum 1

  [[nodiscard]] Point point(std::size_t index) const {
    Point out{};
    for (std::size_t i = kParameters; i-- > 0;) {
      out[i] = axes[i][index % axes[i].size()];
      index /= axes[i].size();
    }
    return out;
  }

  [[nodiscard]] std::vector<double> marginal(std::size_t parameter) const {
    std::size_t inner = 1;
    for (std::size_t i = parameter + 1; i < kParameters; ++i) inner *= axes[i].size();
    std::vector<double> out(axes[parameter].size(), 0.0);
    for (std::size_t i = 0; i < weights.size(); ++i) out[i / inner % out.size()] += weights[i];
    return out;
  }
};

std::vector<double> even_axis(const std::array<double, 2>& ends, std::size_t count) {
  if (ends[0] == ends[1]) return {ends[0]};
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] =
        ends[0] + (ends[1] - ends[0]) * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return out;
}

class Fitter {
 public:
  Fitter(std::span<const Answers> answers, const CurveFitOptions& options)
      : answers_{answers}, options_{options}, beliefs_{answers, options} {}

  [[nodiscard]] double log_posterior(const Point& point) const {
    const double prior = beliefs_.log_prior(point);
    if (prior == kNever) return kNever;
    return prior + log_likelihood(options_.shape, parameters_of(point), answers_);
  }

  [[nodiscard]] Grid solved(const std::array<std::array<double, 2>, kParameters>& ends,
                            const std::array<std::size_t, kParameters>& counts) const {
    Grid grid;
    std::size_t cells = 1;
    for (std::size_t i = 0; i < kParameters; ++i) {
      grid.axes[i] = even_axis(ends[i], counts[i]);
      cells *= grid.axes[i].size();
    }
    grid.weights.resize(cells);
    double best = kNever;
    for (std::size_t i = 0; i < cells; ++i) {
      grid.weights[i] = log_posterior(grid.point(i));
      best = std::max(best, grid.weights[i]);
    }
    double sum = 0;
    for (double& weight : grid.weights) sum += weight = std::exp(weight - best);
    for (double& weight : grid.weights) weight /= sum;
    return grid;
  }

  /// A coarse grid over all that is possible, then a fine one where the posterior is.
  [[nodiscard]] Grid fine_grid() const {
    std::array<std::array<double, 2>, kParameters> ends;
    for (std::size_t i = 0; i < kParameters; ++i) ends[i] = beliefs_.ends(i);
    const Grid coarse = solved(ends, {41, 25, 8, 8, 6});
    for (std::size_t i = 0; i < kParameters; ++i) {
      const auto marginal = coarse.marginal(i);
      const auto seen = [](double weight) { return weight > 1e-5; };
      const auto first = std::ranges::find_if(marginal, seen) - marginal.begin();
      const auto last =
          std::find_if(marginal.rbegin(), marginal.rend(), seen).base() - marginal.begin() - 1;
      const auto count = static_cast<std::ptrdiff_t>(marginal.size());
      const auto& axis = coarse.axes[i];
      ends[i] = {axis[static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, first - 1))],
                 axis[static_cast<std::size_t>(std::min(count - 1, last + 1))]};
    }
    return solved(ends, {40, 40, 20, 20, 12});
  }

  /// The maximum near `from`: a pattern search that halves its steps.
  [[nodiscard]] Point climbed(Point from, const Grid& grid) const {
    Point steps{};
    for (std::size_t i = 0; i < kParameters; ++i) {
      if (grid.axes[i].size() > 1) steps[i] = grid.axes[i][1] - grid.axes[i][0];
    }
    double best = log_posterior(from);
    for (int halving = 0; halving < 40;) {
      const Point begin = from;
      for (std::size_t i = 0; i < kParameters; ++i) {
        for (const double sign : {1.0, -1.0}) {
          Point to = from;
          to[i] += sign * steps[i];
          if (i >= 2) to[i] = std::max(0.0, to[i]);
          if (const double value = log_posterior(to); value > best) {
            best = value;
            from = to;
          }
        }
      }
      if (from == begin) {
        for (double& step : steps) step /= 2;
        ++halving;
      }
    }
    return from;
  }

 private:
  std::span<const Answers> answers_;
  CurveFitOptions options_;
  Beliefs beliefs_;
};

CurveEstimate estimate(const std::vector<double>& axis,
                       const std::vector<double>& marginal,
                       double likeliest) {
  CurveEstimate out{.likeliest = likeliest, .mean = 0, .low = likeliest, .high = likeliest};
  for (std::size_t i = 0; i < axis.size(); ++i) out.mean += axis[i] * marginal[i];
  if (axis.size() == 1) return out;
  const double step = axis[1] - axis[0];
  const auto quantile = [&](double p) {
    double below = 0;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      if (below + marginal[i] >= p) {
        const double at = axis[i] + step * ((p - below) / marginal[i] - 0.5);
        return std::clamp(at, axis.front(), axis.back());
      }
      below += marginal[i];
    }
    return axis.back();
  };
  out.low = quantile(0.025);
  out.high = quantile(0.975);
  return out;
}

double deviance(CurveShape shape,
                const CurveParameters& parameters,
                std::span<const Answers> answers) {
  double out = 0;
  for (const Answers& at : answers) {
    const double share = static_cast<double>(at.yes) / static_cast<double>(at.trials);
    out += 2 * log_of_share(share, at, 0);
  }
  CurveParameters binomial = parameters;
  binomial.dispersion = 0;
  return out - 2 * log_likelihood(shape, binomial, answers);
}

}  // namespace

double curve_value(CurveShape shape, const CurveParameters& p, double level) noexcept {
  switch (shape) {
    case CurveShape::Normal:
      return normal_cdf(kNormalWidth * (level - p.threshold) / p.width);
    case CurveShape::Logistic:
      return 1 / (1 + std::exp(-kLogisticWidth * (level - p.threshold) / p.width));
    case CurveShape::Weibull:
      break;
  }
  if (!(level > 0)) return 0;
  const double slope = (kWeibullHigh - kWeibullLow) / p.width;
  return -std::expm1(-std::exp(slope * std::log(level / p.threshold) + kWeibullMiddle));
}

double log_likelihood(CurveShape shape,
                      const CurveParameters& parameters,
                      std::span<const Answers> answers) noexcept {
  double sum = 0;
  for (const Answers& at : answers) {
    const double share = parameters.guess + (1 - parameters.guess - parameters.lapse) *
                                                curve_value(shape, parameters, at.level);
    sum += log_of_share(share, at, parameters.dispersion);
  }
  return sum;
}

Result<CurveFit> fit_curve(std::span<const Answers> answers, const CurveFitOptions& options) {
  if (answers.size() < 2) return fail("a curve needs answers at two levels at least");
  if (options.shape == CurveShape::Weibull && !(answers.front().level > 0)) {
    return fail("a Weibull curve needs levels above 0");
  }
  const Fitter fitter{answers, options};
  const Grid grid = fitter.fine_grid();
  const auto peak = std::ranges::max_element(grid.weights) - grid.weights.begin();
  const Point likeliest = fitter.climbed(grid.point(static_cast<std::size_t>(peak)), grid);
  const auto of = [&](std::size_t i) {
    return estimate(grid.axes[i], grid.marginal(i), likeliest[i]);
  };
  CurveFit fit{
      .threshold = of(0), .width = of(1), .lapse = of(2), .guess = of(3), .dispersion = of(4)};
  fit.deviance = deviance(options.shape, fit.likeliest(), answers);
  return fit;
}

}  // namespace palp::study
