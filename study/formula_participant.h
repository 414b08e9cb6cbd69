#pragma once

#include <cstddef>
#include <functional>

#include "common/core/result.h"
#include "study/block.h"
#include "study/study_file.h"
#include "study/trial_row.h"

namespace palp::study {

/// Where in a study a trial stands.
struct TrialPlace {
  std::size_t participant{};  ///< from 0
  std::size_t condition{};    ///< of the study file
};

/// Somebody who does a whole trial, or says why it cannot be had. `onset` of the outcome is the
/// caller's. Of simulated ones it depends on the study's seed, the place and the trial's number
/// alone; called from several threads at once, for different participants.
using Observer = std::function<Result<TrialOutcome>(const TrialPlace& place, const TrialAsk& ask)>;

/// Of simulated people: how well they tell stiffness apart where nothing stands between hand and
/// tissue.
struct PeopleTraits {
  double weber{0.15};   ///< [-], > 0: median of their Weber fractions
  double spread{0.25};  ///< [-], standard deviation of the logarithm of their JNDs
  double lapse{0.02};   ///< [-]
};

/// ln JND of one of them [-].
[[nodiscard]] double drawn_ln_jnd(const PeopleTraits& people,
                                  std::uint64_t seed,
                                  std::size_t participant) noexcept;

/// Where a cautious person begins to say yes, above what nothing feels like [standard deviations of
/// one judgement].
inline constexpr double kCriterion = 1;

/// Where one of them begins to say yes, above what nothing feels like [standard deviations of one
/// judgement].
[[nodiscard]] double drawn_criterion(std::uint64_t seed, std::size_t participant) noexcept;

/// What the psychometric function of one of them is like in that study. Who tells two intervals
/// apart by the noise of two judgements finds something in one interval by that of one.
[[nodiscard]] ObserverTraits drawn_traits(const Study& study,
                                          const PeopleTraits& people,
                                          std::size_t participant) noexcept;

/// Time from the question to an answer [s].
[[nodiscard]] double drawn_response_time(std::uint64_t seed,
                                         const TrialPlace& place,
                                         std::size_t trial) noexcept;

/// A stream of random numbers for one thing of one trial.
[[nodiscard]] std::uint64_t trial_stream(const TrialPlace& place, std::size_t trial) noexcept;

/// Answers by the psychometric function, whatever the condition: what an experiment finds where
/// nothing differs. Goes through the stages of a Trial in virtual time.
[[nodiscard]] Observer formula_participants(const Study& study, const PeopleTraits& people);

}  // namespace palp::study
