#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
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
  /// Three intervals are put in order; each is one level stronger than the one before it in that
  /// order, and an answer is one of kOrders.
  bool ranks{};
  /// Which interval was delayed: levels are delays [ms] of the round trip on top of the link's.
  bool delays{};
  /// A place is searched for, and found or not: how many places as wide as what counts as found the
  /// area holds.
  double places{};  ///< [-], above 0; 0: no search
};

/// Intervals that are felt in a trial.
[[nodiscard]] std::size_t felt_intervals(const Task& task) noexcept;
/// Answers there are.
[[nodiscard]] std::size_t choices(const Task& task) noexcept;
/// Share of right answers, or of "the second", of who only guesses [-].
[[nodiscard]] double chance(const Task& task) noexcept;

/// Level that is as hard to tell as an ordinary one of 1 [as the levels]. A delay of 36 ms is
/// noticed as a spring 15 % stiffer is (Rank, Shi, Mueller and Hirche 2010).
[[nodiscard]] double level_unit(const Task& task) noexcept;

/// A level as people say it [% or ms], and what of.
[[nodiscard]] inline double said_level(const Task& task, double level) noexcept {
  return task.delays ? level : percent_of_level(level);
}
[[nodiscard]] inline const char* said_unit(const Task& task) noexcept {
  return task.delays ? "ms" : "%";
}
/// At the end of names of columns and fields that hold levels: "ln" or "ms".
[[nodiscard]] inline std::string level_suffix(const Task& task) {
  return task.delays ? "ms" : "ln";
}

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
/// integral of phi(u - d') Phi(u)^(m-1). m = `intervals` > 1, also between whole numbers; exact for
/// 2, else within 1e-9.
[[nodiscard]] double forced_choice_share(double d_prime, double intervals) noexcept;
/// The same where it stands that far above each of the others, 1 to 7 of them.
[[nodiscard]] double forced_choice_share(std::span<const double> d_primes) noexcept;

/// Share of right orders of three stimuli, of which the second stands `first_step` [-] standard
/// deviations above the first and the third `second_step` above the second, each seen with noise of
/// its own: the integral of phi(u) Phi(u + first_step) Phi(second_step - u).
[[nodiscard]] double order_share(double first_step, double second_step) noexcept;

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
