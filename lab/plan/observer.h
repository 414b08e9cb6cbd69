#pragma once

#include <string>
#include <vector>

#include "lab/plan/batch.h"
#include "lab/plan/plan.h"

namespace palp::lab {

/// A person who is given plain tissue and tissue over an inclusion, one after the other, and says
/// which is stiffer: how often right with what a coupling renders, against the tissue itself.
/// Two-alternative forced choice; stiffness is judged with a Weber fraction, at which the answer is
/// right in 75 of 100 runs.
struct ObserverRow {
  std::vector<std::string> labels;  ///< of the cases, which differ by their seeds only
  double weber{};                   ///< [-]
  double right_true{};              ///< [-], share of right answers with the tissue itself
  double right_felt{};              ///< [-], mean over the seeds
  [[nodiscard]] double loss() const noexcept { return right_true - right_felt; }
};

/// `ratio`: stiffness over the inclusion by that beside it [-], > 0.
[[nodiscard]] double right_answers(double ratio, double weber) noexcept;

/// A row for each group of cases with equal labels and each Weber fraction of 8, 15 and 22 %, in
/// order of the cases. A ratio that is undefined or no ratio is a guess: half right.
[[nodiscard]] std::vector<ObserverRow> observe(const std::vector<CaseResult>& results);

/// The largest loss [-] among the rows whose labels have these values; NaN: there are none.
[[nodiscard]] double worst_loss(const Plan& plan,
                                const std::vector<ObserverRow>& rows,
                                const std::vector<Setting>& labels);

}  // namespace palp::lab
