#pragma once

#include <span>
#include <vector>

/// Statements about conditions from what each participant showed in them. Values are differences of
/// ln JND or of another measure with even errors. Pure.
namespace palp::study {

/// What one participant showed in one condition: of a posterior.
struct Measured {
  double value{};  ///< [-]
  double sd{};     ///< [-], > 0
};

/// exp(second - first): how many times larger the second JND is.
struct RatioStatement {
  double ratio{};   ///< [-], median
  double low{};     ///< [-], 95 % interval
  double high{};    ///< [-]
  double larger{};  ///< [-], probability that the ratio is above 1
};
[[nodiscard]] RatioStatement ratio_of(const Measured& first, const Measured& second) noexcept;

/// Paired differences of a group.
struct PairedTest {
  double mean{};        ///< [-]
  double sd{};          ///< [-], of the differences
  double low{};         ///< [-], 95 % interval of the mean
  double high{};        ///< [-]
  double p{};           ///< [-], two-sided, Student's t
  double p_ranks{};     ///< [-], two-sided, Wilcoxon's signed ranks
  double hedges_g{};    ///< [-], mean over sd, corrected for small groups
  double equivalent{};  ///< [-], p of the two one-sided tests against the margin
};
/// `differences`: 2 at least; `margin` > 0 [-]. Differences that do not differ say nothing of how
/// far they spread: interval, p, g and equivalent are no numbers then.
[[nodiscard]] PairedTest paired_test(std::span<const double> differences, double margin);

/// Participants differ by themselves, and each is measured with an error of its own: value_i ~
/// N(mu + b_i, sd_i^2), b_i ~ N(0, tau^2). Posterior with an even prior of mu, and of tau from 0 to
/// `tau_max`, on a grid.
struct GroupPosterior {
  double mean{};   ///< [-], of mu
  double low{};    ///< [-], 95 % interval of mu
  double high{};   ///< [-]
  double above{};  ///< [-], probability that mu is above 0
  double tau{};    ///< [-], mean
};
[[nodiscard]] GroupPosterior group_posterior(std::span<const Measured> participants,
                                             double tau_max = 1.0);

/// Adjusted so that the family errs no more often than one test would (Holm 1979), in the order
/// given. What is no number stays so, and is none of the family.
[[nodiscard]] std::vector<double> holm_adjusted(std::span<const double> p);

/// Participants that a paired comparison needs to find a difference of `effect` [-] where the
/// differences have the standard deviation `sd` [-]: two-sided 5 %, with the given power. 0 < power
/// < 1, effect and sd > 0; 100,000 at most.
[[nodiscard]] int participants_needed(double effect, double sd, double power = 0.8);

}  // namespace palp::study
