#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/place.h"
#include "study/block.h"
#include "study/level_curves.h"
#include "study/study_file.h"

/// Where on a tissue a study's stimuli lie: a stimulus is a place. Pure.
namespace palp::study {

/// Places of a grid, dealt out by the study's seed, so that where one lies tells nothing of how
/// stiff it is.
struct Tray {
  std::vector<Place> levels{};    ///< of each level of the study
  Place reference{};              ///< what levels are compared with
  std::array<Place, 4> decoys{};  ///< beyond the grid's corners
};

/// All tasks but bias, with at most patient::kPlacesMax - 1 levels.
[[nodiscard]] Tray make_tray(const Study& study);

/// The place of each interval of a trial, and of the stimulus in the `stronger` one the level's.
[[nodiscard]] std::vector<Place> places_of(const Tray& tray,
                                           const Study& study,
                                           const TrialAsk& ask);

/// The tissue as a table for palp-patient: at the reference plain, elsewhere that of the level;
/// between places what lies between.
[[nodiscard]] std::string tray_csv(const Tray& tray, const Study& study, const LevelCurves& curves);

}  // namespace palp::study
