#include "study/answer_posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/core/check.h"

namespace palp::study {
namespace {

std::vector<double> even_steps(double from, double to, std::size_t count) {
  PALP_CHECK(count >= 2, "a grid needs two points");
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1);
  }
  return out;
}

double squared(double x) noexcept { return x * x; }

void normalise(std::vector<double>& weights) {
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
}

/// Weights of the grid points of an even grid are spread evenly over the cells around them.
double quantile(std::span<const double> points, std::span<const double> weights, double p) {
  const double step = points[1] - points[0];
  double below = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (below + weights[i] >= p) {
      return points[i] + step * ((p - below) / weights[i] - 0.5);
    }
    below += weights[i];
  }
  return points.back() + step / 2;
}

Marginal marginal(std::span<const double> points, std::span<const double> weights) {
  Marginal out;
  for (std::size_t i = 0; i < points.size(); ++i) out.mean += points[i] * weights[i];
  for (std::size_t i = 0; i < points.size(); ++i) {
    out.sd += squared(points[i] - out.mean) * weights[i];
  }
  out.sd = std::sqrt(out.sd);
  out.low = quantile(points, weights, 0.025);
  out.median = quantile(points, weights, 0.5);
  out.high = quantile(points, weights, 0.975);
  return out;
}

}  // namespace

AnswerTable::AnswerTable(const Task& task,
                         const ObserverPrior& prior,
                         const ObserverGrid& grid,
                         std::vector<double> levels)
    : task_{task},
      levels_{std::move(levels)},
      ln_jnd_{even_steps(std::log(grid.jnd_min * level_unit(task)),
                         std::log(grid.jnd_max * level_unit(task)),
                         grid.jnd_count)},
      pse_{task.two_sided ? even_steps(-grid.pse_reach, grid.pse_reach, grid.pse_count)
                          : std::vector<double>{0}},
      lapse_{even_steps(0, grid.lapse_max, grid.lapse_count)} {
  const double ln_median = std::log(prior.jnd * level_unit(task));
  PALP_CHECK(!levels_.empty() && std::ranges::is_sorted(levels_), "levels must increase");
  for (const double pse : pse_) {
    for (const double ln_jnd : ln_jnd_) {
      for (const double lapse : lapse_) {
        // The outermost points stand for half a cell.
        const double width = lapse == lapse_.front() || lapse == lapse_.back() ? 0.5 : 1;
        prior_.push_back(width * std::pow(1 - lapse, prior.lapse_shape - 1) *
                         std::exp(-0.5 * squared((ln_jnd - ln_median) / prior.jnd_sd) -
                                  0.5 * squared(pse / prior.pse_sd)));
      }
    }
  }
  normalise(prior_);
  shares_.reserve(levels_.size() * prior_.size());
  const double guess = chance(task);
  for (const double level : levels_) {
    for (const double pse : pse_) {
      for (const double ln_jnd : ln_jnd_) {
        const double told = answer_share(task, {.jnd = std::exp(ln_jnd), .pse = pse}, level);
        for (const double lapse : lapse_) shares_.push_back(lapse * guess + (1 - lapse) * told);
      }
    }
  }
}

std::size_t AnswerTable::nearest(double wanted) const noexcept {
  const auto above = std::ranges::lower_bound(levels_, wanted);
  if (above == levels_.begin()) return 0;
  if (above == levels_.end()) return levels_.size() - 1;
  const auto index = static_cast<std::size_t>(above - levels_.begin());
  return wanted - levels_[index - 1] < levels_[index] - wanted ? index - 1 : index;
}

AnswerPosterior::AnswerPosterior(const AnswerTable& table)
    : table_{&table}, weights_(table.prior().begin(), table.prior().end()) {}

void AnswerPosterior::told(std::size_t level, bool yes) {
  const auto shares = table_->shares(level);
  std::vector<double> next(weights_.size());
  double sum = 0;
  for (std::size_t i = 0; i < next.size(); ++i) {
    next[i] = weights_[i] * (yes ? shares[i] : 1 - shares[i]);
    sum += next[i];
  }
  if (!(sum > 0)) return;
  for (double& weight : next) weight /= sum;
  weights_ = std::move(next);
}

Marginal AnswerPosterior::ln_jnd() const {
  const std::size_t lapses = table_->lapse().size();
  const std::size_t jnds = table_->ln_jnd().size();
  std::vector<double> sums(jnds, 0.0);
  for (std::size_t i = 0; i < weights_.size(); ++i) sums[i / lapses % jnds] += weights_[i];
  return marginal(table_->ln_jnd(), sums);
}

Marginal AnswerPosterior::pse() const {
  if (!table_->task().two_sided) return {};
  const std::size_t block = table_->lapse().size() * table_->ln_jnd().size();
  std::vector<double> sums(table_->pse().size(), 0.0);
  for (std::size_t i = 0; i < weights_.size(); ++i) sums[i / block] += weights_[i];
  return marginal(table_->pse(), sums);
}

double AnswerPosterior::lapse_mean() const {
  const std::size_t lapses = table_->lapse().size();
  double mean = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    mean += weights_[i] * table_->lapse()[i % lapses];
  }
  return mean;
}

double AnswerPosterior::expected_entropy(std::size_t level) const {
  const auto shares = table_->shares(level);
  const std::size_t lapses = table_->lapse().size();
  const auto nats = [](double p) { return p > 0 ? -p * std::log(p) : 0.0; };
  double entropy = 0;  // of the joint distribution of answer and observer
  double all_yes = 0;
  for (std::size_t i = 0; i < weights_.size(); i += lapses) {
    double yes = 0;
    double any = 0;
    for (std::size_t j = i; j < i + lapses; ++j) {
      yes += weights_[j] * shares[j];
      any += weights_[j];
    }
    entropy += nats(yes) + nats(std::max(0.0, any - yes));
    all_yes += yes;
  }
  return entropy - nats(all_yes) - nats(std::max(0.0, 1 - all_yes));
}

}  // namespace palp::study
