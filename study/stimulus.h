#pragma once

#include <vector>

#include "study/block.h"
#include "study/study_file.h"

/// What each interval of a trial is made of. Pure.
namespace palp::study {

/// Of one interval.
struct Stimulus {
  /// [-], of the tissue: ln of its stiffness over the plain one's, of a ball its contrast. Levels
  /// of a ranking: below and above the tissue in the middle.
  double level{};
  double delay{};  ///< [ms], of the round trip, on top of the link's
};

/// In the order in which they are felt.
[[nodiscard]] std::vector<Stimulus> stimuli_of(const TrialAsk& ask, const Task& task);

/// Every tissue level that trials of a study may have, the plain one first; a ranking: the middle
/// one.
[[nodiscard]] std::vector<double> tissue_levels(const Study& study);

}  // namespace palp::study
