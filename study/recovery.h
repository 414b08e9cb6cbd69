#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "study/track.h"

/// Does the pipeline find a known truth? Simulated observers with drawn traits go through a method
/// and its estimate. Pure; the ith observer depends on (seed, i) alone.
namespace palp::study {

struct RecoverySet {
  Task task{};
  Method method{};
  ObserverPrior prior{};
  double level_min{0.02};  ///< [-]
  double level_max{1.2};   ///< [-]
  std::size_t levels{25};
  double jnd_min{0.08};    ///< [-], drawn evenly in its logarithm
  double jnd_max{0.30};    ///< [-]
  double lapse_min{};      ///< [-], drawn evenly
  double lapse_max{0.05};  ///< [-]
  std::uint64_t seed{1};
};

struct RecoveryCase {
  ObserverTraits truth{};
  std::size_t trials{};
  Marginal ln_jnd{};
};

/// Calls work(i) for i below count, in any order, perhaps at once.
using ForEachIndex =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

[[nodiscard]] std::vector<RecoveryCase> recover(const RecoverySet& set,
                                                std::size_t observers,
                                                const ForEachIndex& for_each_index);

/// Of ln JND, over all cases.
struct RecoverySummary {
  double trials{};  ///< [-], mean
  double bias{};    ///< [-]
  double sd{};      ///< [-]
  double bound{};   ///< [-], Cramer and Rao: root of the mean of their squares
  double held{};    ///< [-], share of truths within the 95 % intervals
};
[[nodiscard]] RecoverySummary summary_of(const RecoverySet& set,
                                         std::span<const RecoveryCase> cases);

/// Experiments in which two conditions do not differ, or differ by a known ratio.
struct GroupSet {
  RecoverySet observers{};
  std::size_t participants{16};
  double spread{0.25};    ///< [-], of participants' ln JND around the median of the set
  double condition_ln{};  ///< [-], ln of the second condition's JND over the first's
  double margin{0.15};    ///< [-], of equivalence
};
struct GroupSummary {
  double found{};  ///< [-], share of experiments with p below 5 %
  double equal{};  ///< [-], share called equivalent
  double held{};   ///< [-], share whose 95 % interval holds condition_ln
};
[[nodiscard]] GroupSummary repeat_group(const GroupSet& set,
                                        std::size_t experiments,
                                        const ForEachIndex& for_each_index);

/// Yes or no, with known d' and criterion.
inline constexpr std::array kKnownSensitivities{1.0, 1.5, 2.0};  ///< [-], d'
inline constexpr double kKnownCriterion = 0.3;                   ///< [-]
struct YesNoSummary {
  double d_prime_bias{};    ///< [-]
  double criterion_bias{};  ///< [-]
  double d_prime_held{};    ///< [-], share within 1.96 standard deviations
  double criterion_held{};  ///< [-]
};
[[nodiscard]] YesNoSummary recover_yes_no(double d_prime,
                                          double criterion,
                                          std::size_t trials_of_each_kind,
                                          std::size_t observers,
                                          std::uint64_t seed);

}  // namespace palp::study
