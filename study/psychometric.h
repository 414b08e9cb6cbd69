#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

/// Which answers a level draws from an observer. Levels are logarithms of ratios [-]: 0 is "equal",
/// 0.14 is 15 % stiffer. All functions are pure.
namespace palp::study {

/// [-], standard deviations: 75 % of the normal distribution lie below. One JND in a two-sided
/// task.
inline constexpr double kQuartile = 0.674489750196081743;

/// A level as people say it: 0.14 is 15 [%].
[[nodiscard]] inline double percent_of_level(double level) noexcept {
  return 100 * std::expm1(level);
}

/// What is asked.
struct Task {
  /// Intervals of a forced choice, 2 to 8; one of them holds the stronger stimulus.
  int intervals{2};
  /// Levels have both signs and the question is "is the second stiffer?": measures bias as well.
  bool two_sided{};
  /// One interval, and the question is "is there something?": two_sided, with levels from 0, where
  /// there is nothing. The JND is then 0.674 of the level at d' = 1, the PSE the observer's
  /// criterion as a level.
  bool yes_no{};
};

/// Of one observer in one condition.
struct ObserverTraits {
  double jnd{};    ///< [-], > 0: difference told apart half of the time, after chance
  double pse{};    ///< [-], two-sided tasks: level that seems equal
  double lapse{};  ///< [-], 0 to 1: share of answers that are guesses
};

/// One level and what was answered there.
struct Answers {
  double level{};        ///< [-]
  std::size_t yes{};     ///< right, or "the second is stiffer"
  std::size_t trials{};  ///< >= yes
};

/// Share of right answers where the stronger stimulus stands `d_prime` [-] standard deviations
/// above the others, each of which is seen with noise of its own (Green and Swets 1966): the
/// integral of phi(u - d') Phi(u)^(m-1). 2 <= intervals <= 8; exact for 2, else within 1e-10.
[[nodiscard]] double forced_choice_share(double d_prime, int intervals) noexcept;
/// The same where it stands that far above each of the others, 1 to 7 of them.
[[nodiscard]] double forced_choice_share(std::span<const double> d_primes) noexcept;

/// The inverse: d' >= 0 for a share from 1/m to below 1.
[[nodiscard]] double d_prime_of_share(double share, int intervals) noexcept;

/// d' [-] at a level of one JND: half way between chance and certainty.
[[nodiscard]] double d_prime_at_jnd(const Task& task) noexcept;

/// Share [-] of right answers at `level` >= 0, or of "the second is stiffer" at any level.
[[nodiscard]] double answer_share(const Task& task,
                                  const ObserverTraits& traits,
                                  double level) noexcept;

/// Fisher's information on ln JND [-] of one answer at `level`, everything else known.
[[nodiscard]] double jnd_information(const Task& task,
                                     const ObserverTraits& traits,
                                     double level) noexcept;

/// Smallest standard deviation [-] of ln JND that `trials` answers allow, all at the level that
/// tells most (Cramer and Rao), everything else known.
[[nodiscard]] double jnd_bound(const Task& task, const ObserverTraits& traits, std::size_t trials);

/// `count` >= 2 levels from `low` to `high`, each the same factor above the one before. 0 < low.
[[nodiscard]] std::vector<double> even_levels(double low, double high, std::size_t count);

/// Answers with equal levels put together, in order of the levels.
[[nodiscard]] std::vector<Answers> pooled(std::span<const Answers> answers);

}  // namespace palp::study
