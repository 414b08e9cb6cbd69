#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "study/data_set.h"

/// What a study's answers are worth: are they those that its schedule asks for, and of whom?
namespace palp::study {

/// What the answers show once they are told to the schedule again.
struct StudyReplay {
  std::vector<std::string> faults{};  ///< a sentence each
  std::size_t done{};                 ///< participants who answered all, or are excluded by rule
};
/// Besides the answers themselves: who is none of the study's, who withdrew and is still there,
/// and kinds that are mixed. An error: something cannot be read.
[[nodiscard]] Result<StudyReplay> replay_study(const PlannedStudy& planned,
                                               const std::vector<ParticipantRows>& rows);

/// "confirmatory: ..." of people with an approval alone; of simulated answers "simulated: ..." and
/// whether they are as registered; else "exploratory: " and why. Then whether somebody looked
/// before all had answered.
[[nodiscard]] Result<std::string> standing(const PlannedStudy& planned,
                                           const std::vector<ParticipantRows>& rows);

/// That somebody sees which condition has which letter is written down in code/unblinded.txt, with
/// how much was answered by then.
[[nodiscard]] Result<void> log_unblinding(const PlannedStudy& planned,
                                          const std::vector<ParticipantRows>& rows);
/// "; unblinded after 40 answers of 2 participants", where all had not answered yet; else empty.
[[nodiscard]] Result<std::string> early_look(const DataSet& data);

}  // namespace palp::study
