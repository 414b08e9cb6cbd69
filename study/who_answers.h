#pragma once

#include <string>
#include <vector>

#include "study/data_set.h"
#include "study/formula_participant.h"
#include "study/run_lock.h"

namespace palp::study {

/// Who answers in a study's folder: people, a pilot's, or simulated ones of one observer with one
/// set of traits.
struct WhoAnswers {
  std::string kind{};      ///< as a row has it
  std::string observer{};  ///< of simulated ones: which
  PeopleTraits people{};   ///< likewise
};

/// Binds the folder to them, in code/observer.json, where nobody has answered yet; later refuses
/// everybody else, so that answers of one folder are of one kind.
/// Nobody binds it anew while somebody runs: the lock lasts as long as the run.
[[nodiscard]] Result<RunLock> bind_folder(const PlannedStudy& planned, const WhoAnswers& who);

/// Kinds that the rows have, in order, each once.
[[nodiscard]] std::vector<std::string> kinds_of(const std::vector<ParticipantRows>& rows);
/// The kind that the folder is bound to; empty: none yet.
[[nodiscard]] Result<std::string> bound_kind(const DataSet& data);

}  // namespace palp::study
