#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/answer_posterior.h"
#include "study/compare.h"
#include "study/data_set.h"
#include "study/signal_detection.h"

/// What the answers of a study's participants say. Pure.
namespace palp::study {

/// One participant under one condition.
struct FittedBlock {
  std::string id{};
  std::size_t condition{};  ///< of the study file
  std::size_t trials{};     ///< answered, catch trials included
  bool complete{};
  Marginal ln_jnd{};
  Marginal pse{};
  double lapse{};                            ///< [-], mean
  std::optional<Sensitivity> sensitivity{};  ///< yes or no: of all that lay there against nothing
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

/// `rows` as read_rows() gives them.
[[nodiscard]] StudyFit fit_study(const Study& study, const std::vector<ParticipantRows>& rows);

/// Two conditions, from those who answered all of both and are not excluded.
struct ConditionPair {
  std::size_t first{};
  std::size_t second{};
  std::size_t participants{};
  PairedTest test{};  ///< of ln JND, or of the PSE
  double p_holm{};    ///< [-]
  GroupPosterior group{};
  std::vector<Measured> differences{};  ///< [-], of each participant
};

/// Each pair of conditions in the order of the study file; none where fewer than two took part.
/// `bias`: PSEs instead of JNDs.
[[nodiscard]] std::vector<ConditionPair> compare_study(const Study& study,
                                                       const StudyFit& fit,
                                                       bool bias);

/// The blocks of one condition that count.
[[nodiscard]] std::vector<FittedBlock> counted(const StudyFit& fit, std::size_t condition);

/// derivatives/palp-study/fit.tsv. `names`: of the conditions, codes unless unblinded.
[[nodiscard]] std::string fit_table(const Study& study,
                                    const StudyFit& fit,
                                    const std::vector<std::string>& names);

/// A line on a condition: JND, and of tasks of detection depth, d' and criterion, over those who
/// count. Empty: nobody does.
[[nodiscard]] std::string condition_text(const Study& study,
                                         const StudyFit& fit,
                                         std::size_t condition,
                                         const std::string& name);

/// The letters of all conditions.
[[nodiscard]] std::vector<std::string> condition_codes(const Study& study);

}  // namespace palp::study
