#pragma once

#include <cstdint>
#include <string>

#include "study/block.h"
#include "study/person_trial.h"
#include "study/study_file.h"

/// What a participant's page shows: nothing of it depends on what lies where or on the level, and
/// of the condition only whether the force is drawn. Pure.
namespace palp::study {

/// What a view says besides.
struct ViewSetting {
  std::uint32_t number{};  ///< of the trial, as its answer says it
  bool right{};            ///< of a practice trial that was answered
  bool draws_force{};      ///< of the condition
};

/// JSON for the page.
[[nodiscard]] std::string trial_view(const Study& study,
                                     const TrialAsk& ask,
                                     const PersonTrial& trial,
                                     const ViewSetting& setting);

/// Between two conditions, and at the end.
[[nodiscard]] std::string rest_view(int seconds_left);
[[nodiscard]] std::string end_view();

}  // namespace palp::study
