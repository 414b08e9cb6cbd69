#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/answer_posterior.h"
#include "study/compare.h"
#include "study/data_set.h"
#include "study/signal_detection.h"

/// What the answers of a study's participants say. Pure.
namespace palp::study {

/// What a participant is compared by from one condition to the next.
enum class Measure : std::uint8_t {
  Jnd,    ///< ln JND
  Pse,    ///< two-sided tasks
  Tau,    ///< rankings: Kendall's, mean
  Error,  ///< searches: ln of the error, mean
  Time,   ///< searches: ln of the time, mean
};
/// Those of a task, the first one first.
[[nodiscard]] std::vector<Measure> measures_of(const Task& task);
/// "jnd".
[[nodiscard]] std::string_view to_string(Measure measure) noexcept;
/// Of a measure that is a logarithm: differences are ratios.
[[nodiscard]] constexpr bool is_ratio(Measure measure) noexcept {
  return measure != Measure::Pse && measure != Measure::Tau;
}

/// How a participant searched: medians over the trials, but for error and time.
struct SearchFigures {
  double path{};        ///< [m]
  double contacts{};    ///< [1]
  double force_mean{};  ///< [N]
  double force_max{};   ///< [N]
  Measured ln_error{};  ///< of metres, from what was hidden, mean
  Measured ln_time{};   ///< of seconds, mean
};

/// One participant under one condition.
struct FittedBlock {
  std::string id{};
  std::size_t condition{};  ///< of the study
  std::size_t trials{};     ///< answered, catch trials included
  bool complete{};
  Marginal ln_jnd{};
  Marginal pse{};
  double lapse{};                            ///< [-], mean
  std::optional<Sensitivity> sensitivity{};  ///< yes or no: of all that lay there against nothing
  std::optional<Measured> kendall_tau{};     ///< a ranking: mean, catch trials left out
  std::optional<SearchFigures> search{};     ///< a search: catch trials left out
  std::vector<Answers> answers{};            ///< pooled, without practice
};

/// Who is left out, and why.
struct Exclusion {
  std::string id{};
  std::string why{};
};

struct StudyFit {
  std::vector<FittedBlock> blocks{};  ///< by participant, then by condition
  std::vector<Exclusion> excluded{};
  std::size_t participants{};  ///< with any answer
};

/// By the rules of the study.
[[nodiscard]] std::vector<Exclusion> exclusions(const Study& study,
                                                const std::vector<ParticipantRows>& rows);

/// `rows` as read_rows() gives them.
[[nodiscard]] StudyFit fit_study(const Study& study, const std::vector<ParticipantRows>& rows);

/// Two conditions, from those who answered all of both and are not excluded.
struct ConditionPair {
  std::size_t first{};
  std::size_t second{};
  std::size_t participants{};
  PairedTest test{};  ///< of the measure
  double p_holm{};    ///< [-]
  GroupPosterior group{};
  std::vector<Measured> differences{};  ///< [-], of each participant
};

/// Each pair of conditions in the order of the study; none where fewer than two took part.
[[nodiscard]] std::vector<ConditionPair> compare_study(const Study& study,
                                                       const StudyFit& fit,
                                                       Measure measure);

/// The blocks of one condition that count.
[[nodiscard]] std::vector<FittedBlock> counted(const StudyFit& fit, std::size_t condition);

/// derivatives/palp-study/fit.tsv. `names`: of the conditions, codes unless unblinded. `blind`:
/// touches and forces of a search are left out, for they tell conditions that differ in them.
[[nodiscard]] std::string fit_table(const Study& study,
                                    const StudyFit& fit,
                                    const std::vector<std::string>& names,
                                    bool blind);

/// A line on a condition, over those who count: JND, and what else the task measures. Empty: nobody
/// does.
[[nodiscard]] std::string condition_text(const Study& study,
                                         const StudyFit& fit,
                                         std::size_t condition,
                                         const std::string& name);

/// The letters of all conditions.
[[nodiscard]] std::vector<std::string> condition_codes(const Study& study);

}  // namespace palp::study
