#include "study/compare.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "common/core/check.h"
#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kTwoSided = 1.959963984540054;  // of the normal distribution, 95 %

/// Probability that Student's t with `freedom` degrees is above `t`.
double above_t(double t, double freedom) {
  if (!std::isfinite(t)) return t > 0 ? 0 : 1;
  return boost::math::cdf(boost::math::complement(boost::math::students_t{freedom}, t));
}

/// Two-sided p of the signed ranks: exact to 20 differences, beyond that normal.
double wilcoxon(std::span<const double> differences) {
  std::vector<double> sizes;
  for (const double one : differences) {
    if (one != 0) sizes.push_back(std::abs(one));
  }
  const std::size_t n = sizes.size();
  if (n == 0) return 1;
  std::ranges::sort(sizes);
  const auto doubled_rank = [&](double size) {  // twice the mean rank, whole also for ties
    const auto [first, last] = std::equal_range(sizes.begin(), sizes.end(), size);
    return static_cast<std::size_t>((first - sizes.begin()) + (last - sizes.begin()) + 1);
  };
  std::size_t positive = 0;
  for (const double one : differences) {
    if (one > 0) positive += doubled_rank(one);
  }
  const std::size_t all = n * (n + 1);
  const std::size_t extreme = std::max(positive, all - positive);
  if (n > 20) {
    double variance = 0;
    for (const double size : sizes) {
      const auto rank = static_cast<double>(doubled_rank(size)) / 2;
      variance += rank * rank / 4;
    }
    const double z = (static_cast<double>(extreme) - static_cast<double>(all) / 2) / 2;
    return std::min(1.0, 2 * normal_cdf(-(z - 0.5) / std::sqrt(variance)));
  }
  std::vector<double> ways(all + 1, 0.0);  // of signs, by their doubled sum
  ways[0] = 1;
  for (const double size : sizes) {
    const std::size_t rank = doubled_rank(size);
    for (std::size_t sum = all + 1; sum-- > rank;) ways[sum] += ways[sum - rank];
  }
  const double beyond =
      std::accumulate(ways.begin() + static_cast<std::ptrdiff_t>(extreme), ways.end(), 0.0);
  return std::min(1.0, 2 * beyond / std::exp2(static_cast<double>(n)));
}

}  // namespace

RatioStatement ratio_of(const Measured& first, const Measured& second) noexcept {
  const double mean = second.value - first.value;
  const double sd = std::hypot(first.sd, second.sd);
  return {std::exp(mean),
          std::exp(mean - kTwoSided * sd),
          std::exp(mean + kTwoSided * sd),
          normal_cdf(mean / sd)};
}

PairedTest paired_test(std::span<const double> differences, double margin) {
  PALP_CHECK(differences.size() >= 2 && margin > 0, "a paired test needs two differences");
  const auto n = static_cast<double>(differences.size());
  PairedTest out;
  out.mean = std::accumulate(differences.begin(), differences.end(), 0.0) / n;
  double squares = 0;
  for (const double one : differences) squares += (one - out.mean) * (one - out.mean);
  const double freedom = n - 1;
  out.sd = std::sqrt(squares / freedom);
  out.p_ranks = wilcoxon(differences);
  constexpr double kSdLeast = 1e-12;  // [-], below it is rounding: nothing is known of the spread
  if (out.sd < kSdLeast) {
    out.low = out.high = out.p = out.hedges_g = out.equivalent =
        std::numeric_limits<double>::quiet_NaN();
    return out;
  }
  const double error = out.sd / std::sqrt(n);
  const double reach = boost::math::quantile(boost::math::students_t{freedom}, 0.975) * error;
  out.low = out.mean - reach;
  out.high = out.mean + reach;
  out.p = out.mean == 0 ? 1 : std::min(1.0, 2 * above_t(std::abs(out.mean) / error, freedom));
  out.hedges_g = out.mean / out.sd * (1 - 3 / (4 * freedom - 1));
  out.equivalent = std::max(above_t((margin - out.mean) / error, freedom),
                            above_t((margin + out.mean) / error, freedom));
  return out;
}

GroupPosterior group_posterior(std::span<const Measured> participants, double tau_max) {
  PALP_CHECK(!participants.empty() && tau_max > 0, "a group needs participants");
  constexpr int kCells = 200;
  // Given tau, mu is normal: its weighted mean, and how well the values agree with it.
  struct Slice {
    double weight{};
    double mean{};
    double sd{};
  };
  std::vector<Slice> slices;
  double best = -1e300;
  for (int i = 0; i < kCells; ++i) {
    const double tau = tau_max * (i + 0.5) / kCells;
    double precision = 0;
    double sum = 0;
    double logs = 0;
    for (const Measured& one : participants) {
      const double variance = one.sd * one.sd + tau * tau;
      precision += 1 / variance;
      sum += one.value / variance;
      logs -= 0.5 * std::log(variance);
    }
    const double mean = sum / precision;
    for (const Measured& one : participants) {
      logs -= 0.5 * (one.value - mean) * (one.value - mean) / (one.sd * one.sd + tau * tau);
    }
    logs -= 0.5 * std::log(precision);
    slices.push_back({logs, mean, 1 / std::sqrt(precision)});
    best = std::max(best, logs);
  }
  double all = 0;
  for (Slice& slice : slices) all += slice.weight = std::exp(slice.weight - best);
  GroupPosterior out;
  for (int i = 0; i < kCells; ++i) {
    Slice& slice = slices[static_cast<std::size_t>(i)];
    slice.weight /= all;
    out.mean += slice.weight * slice.mean;
    out.tau += slice.weight * tau_max * (i + 0.5) / kCells;
  }
  const auto below = [&](double mu) {
    double share = 0;
    for (const Slice& slice : slices) {
      share += slice.weight * normal_cdf((mu - slice.mean) / slice.sd);
    }
    return share;
  };
  const auto quantile = [&](double p) {
    double low = out.mean - 20 * tau_max;
    double high = out.mean + 20 * tau_max;
    for (int i = 0; i < 80; ++i) {
      const double middle = (low + high) / 2;
      (below(middle) < p ? low : high) = middle;
    }
    return (low + high) / 2;
  };
  out.low = quantile(0.025);
  out.high = quantile(0.975);
  out.above = 1 - below(0);
  return out;
}

std::vector<double> holm_adjusted(std::span<const double> p) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!std::isnan(p[i])) order.push_back(i);
  }
  std::ranges::sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> out(p.size(), std::numeric_limits<double>::quiet_NaN());
  double before = 0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const double adjusted =
        std::min(1.0, static_cast<double>(order.size() - rank) * p[order[rank]]);
    out[order[rank]] = before = std::max(before, adjusted);
  }
  return out;
}

int participants_needed(double effect, double sd, double power) {
  PALP_CHECK(effect > 0 && sd > 0 && power > 0 && power < 1, "power needs an effect");
  for (int n = 2; n < 100'000; ++n) {
    const double freedom = n - 1;
    const double critical = boost::math::quantile(boost::math::students_t{freedom}, 0.975);
    const double shift = effect / sd * std::sqrt(static_cast<double>(n));
    if (shift > 30) return n;
    const boost::math::non_central_t shifted{freedom, shift};
    const double found = boost::math::cdf(boost::math::complement(shifted, critical)) +
                         boost::math::cdf(shifted, -critical);
    if (found >= power) return n;
  }
  return 100'000;
}

}  // namespace palp::study
