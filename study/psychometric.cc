#include "study/psychometric.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/check.h"
#include "common/core/random.h"
#include "study/orders.h"

namespace palp::study {
namespace {

constexpr double kTail = 8.5;  // [-], standard deviations; 1e-17 lie beyond
constexpr int kSteps = 400;    // of the integral, even

double density(double z) noexcept { return std::exp(-0.5 * z * z) * 0.398942280401432678; }

/// Of a function of a standard normal number, by Simpson's rule.
template <class Function>
double mean_of_normal(Function function) noexcept {
  const double step = 2 * kTail / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -kTail + step * i;
    sum += density(z) * (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * function(z);
  }
  return sum * step / 3;
}

/// Of right answers, by who attends.
double told_share(const Task& task, double d_prime) noexcept {
  if (task.ranks) return order_share(d_prime, d_prime);
  return forced_choice_share(d_prime, task.places > 0 ? task.places : task.intervals);
}

}  // namespace

std::size_t felt_intervals(const Task& task) noexcept {
  return task.yes_no || task.places > 0 ? 1 : static_cast<std::size_t>(task.intervals);
}

std::size_t choices(const Task& task) noexcept {
  if (task.yes_no || task.places > 0) return 2;
  return task.ranks ? kOrders.size() : static_cast<std::size_t>(task.intervals);
}

double chance(const Task& task) noexcept {
  if (task.places > 0) return 1 / task.places;
  return 1 / static_cast<double>(choices(task));
}

double level_unit(const Task& task) noexcept {
  constexpr double kMilliseconds = 240;  // [ms], of which 15 % are 36
  return task.delays ? kMilliseconds : 1;
}

double forced_choice_share(std::span<const double> d_primes) noexcept {
  PALP_CHECK(!d_primes.empty() && d_primes.size() <= 7, "a forced choice has 2 to 8 intervals");
  if (d_primes.size() == 1) return normal_cdf(d_primes.front() / std::sqrt(2.0));
  return mean_of_normal([d_primes](double z) {
    double told = 1;
    for (const double d_prime : d_primes) told *= normal_cdf(z + d_prime);
    return told;
  });
}

double forced_choice_share(double d_prime, double intervals) noexcept {
  PALP_CHECK(intervals > 1, "a choice is between two at least");
  if (intervals == 2) return normal_cdf(d_prime / std::sqrt(2.0));
  return mean_of_normal([=](double z) { return std::pow(normal_cdf(z + d_prime), intervals - 1); });
}

double order_share(double first_step, double second_step) noexcept {
  return mean_of_normal(
      [=](double z) { return normal_cdf(z + first_step) * normal_cdf(second_step - z); });
}

double d_prime_at_jnd(const Task& task) noexcept {
  const bool of_two = task.intervals == 2 && !task.ranks && task.places == 0;
  if (task.two_sided || of_two) return std::sqrt(2.0) * kQuartile;
  // Asked for at every level of every cell of a grid: the last answer is kept.
  thread_local Task known{};
  thread_local double d_prime = 0;
  const bool same =
      known.intervals == task.intervals && known.ranks == task.ranks && known.places == task.places;
  if (same && d_prime > 0) return d_prime;
  const double wanted = (1 + chance(task)) / 2;
  double low = 0;
  double high = 2 * kTail;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (told_share(task, middle) < wanted ? low : high) = middle;
  }
  known = task;
  return d_prime = (low + high) / 2;
}

double answer_share(const Task& task, const ObserverTraits& traits, double level) noexcept {
  const double told = task.two_sided ? normal_cdf(kQuartile * (level - traits.pse) / traits.jnd)
                                     : told_share(task, d_prime_at_jnd(task) * level / traits.jnd);
  return traits.lapse * chance(task) + (1 - traits.lapse) * told;
}

double jnd_information(const Task& task, const ObserverTraits& traits, double level) noexcept {
  constexpr double kStep = 1e-4;
  ObserverTraits more = traits;
  ObserverTraits less = traits;
  more.jnd *= std::exp(kStep);
  less.jnd *= std::exp(-kStep);
  const double slope =
      (answer_share(task, more, level) - answer_share(task, less, level)) / (2 * kStep);
  const double share = answer_share(task, traits, level);
  const double variance = share * (1 - share);
  return variance > 0 ? slope * slope / variance : 0;
}

double jnd_bound(const Task& task, const ObserverTraits& traits, std::size_t trials) {
  PALP_CHECK(trials > 0, "a bound needs trials");
  double best = 0;
  for (const double units : even_levels(0.05, 8, 400)) {
    best = std::max(best, jnd_information(task, traits, traits.pse + units * traits.jnd));
  }
  return 1 / std::sqrt(best * static_cast<double>(trials));
}

std::vector<double> even_levels(double low, double high, std::size_t count) {
  PALP_CHECK(low > 0 && high > low && count >= 2, "levels need a range above 0");
  std::vector<double> levels(count);
  const double step = std::log(high / low) / static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i) levels[i] = low * std::exp(step * static_cast<double>(i));
  return levels;
}

std::vector<Answers> pooled(std::span<const Answers> answers) {
  std::vector<Answers> all(answers.begin(), answers.end());
  std::ranges::stable_sort(all, {}, &Answers::level);
  std::vector<Answers> out;
  for (const Answers& one : all) {
    if (out.empty() || out.back().level != one.level) {
      out.push_back(one);
    } else {
      out.back().yes += one.yes;
      out.back().trials += one.trials;
    }
  }
  return out;
}

}  // namespace palp::study
