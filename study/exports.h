#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/data_fit.h"

/// A study's answers as other tools read them. Practice is left out. Pure.
namespace palp::study {

inline constexpr std::string_view kExportFormats[]{
    "psignifit", "quickpsy", "palamedes", "psychopy", "lme4"};

/// - psignifit: rows of level, right ones, all: its data matrix; a block for each participant and
///   condition, begun by a comment line ("#");
/// - quickpsy: tidy CSV, a row a trial: participant, condition, level, response, excluded;
/// - palamedes: a .m script that fills StimLevels, NumPos, OutOfNum, a row for each participant and
///   condition;
/// - psychopy: wide CSV as its TrialHandler writes it: participant, session, trials.thisN,
///   trials.intensity, trials.response, trials.rt, condition, excluded;
/// - lme4: CSV, a row a trial: participant, condition, level, correct, trial, excluded; for
///   glmer(correct ~ 0 + level:condition + (0 + level | participant), binomial("probit")),
///   without an intercept: of two equal ones half are chosen, so a JND is qnorm(0.75) over a slope.
///   Whether conditions differ is for (0 + level:condition | participant) and a likelihood ratio:
///   people differ in how much they do.
///   At two-sided tasks the intercept is the bias, and the model has one for each condition:
///   correct ~ 0 + condition + level:condition + (1 + level | participant).
/// `excluded` is 1 where the participant is left out by the rules of the study: psignifit and
/// palamedes have no place for it. nullopt: no such format.
[[nodiscard]] std::optional<std::string> export_text(std::string_view format,
                                                     const std::vector<ParticipantRows>& rows,
                                                     const std::vector<Exclusion>& excluded);

}  // namespace palp::study
