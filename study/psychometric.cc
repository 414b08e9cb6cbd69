#include "study/psychometric.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/check.h"
#include "common/core/random.h"

namespace palp::study {
namespace {

constexpr double kTail = 8.5;  // [-], standard deviations; 1e-17 lie beyond
constexpr int kSteps = 400;    // of the integral, even

double density(double z) noexcept { return std::exp(-0.5 * z * z) * 0.398942280401432678; }

}  // namespace

double forced_choice_share(std::span<const double> d_primes) noexcept {
  PALP_CHECK(!d_primes.empty() && d_primes.size() <= 7, "a forced choice has 2 to 8 intervals");
  if (d_primes.size() == 1) return normal_cdf(d_primes.front() / std::sqrt(2.0));
  // Simpson's rule over the stronger stimulus.
  const double step = 2 * kTail / kSteps;
  double sum = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -kTail + step * i;
    double told = density(z) * (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2);
    for (const double d_prime : d_primes) told *= normal_cdf(z + d_prime);
    sum += told;
  }
  return sum * step / 3;
}

double forced_choice_share(double d_prime, int intervals) noexcept {
  PALP_CHECK(intervals >= 2 && intervals <= 8, "a forced choice has 2 to 8 intervals");
  std::array<double, 7> d_primes{};
  d_primes.fill(d_prime);
  return forced_choice_share(std::span{d_primes}.first(static_cast<std::size_t>(intervals - 1)));
}

double d_prime_of_share(double share, int intervals) noexcept {
  if (intervals == 2) return std::sqrt(2.0) * normal_quantile(share);
  double low = 0;
  double high = 2 * kTail;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (forced_choice_share(middle, intervals) < share ? low : high) = middle;
  }
  return (low + high) / 2;
}

double d_prime_at_jnd(const Task& task) noexcept {
  if (task.two_sided || task.intervals == 2) return std::sqrt(2.0) * kQuartile;
  const double chance = 1.0 / task.intervals;
  return d_prime_of_share(chance + (1 - chance) / 2, task.intervals);
}

double answer_share(const Task& task, const ObserverTraits& traits, double level) noexcept {
  const double told = [&] {
    if (task.two_sided) return normal_cdf(kQuartile * (level - traits.pse) / traits.jnd);
    return forced_choice_share(d_prime_at_jnd(task) * level / traits.jnd, task.intervals);
  }();
  const double guess = task.two_sided ? 0.5 : 1.0 / task.intervals;
  return traits.lapse * guess + (1 - traits.lapse) * told;
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
