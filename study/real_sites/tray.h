#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/place.h"
#include "study/block.h"
#include "study/level_curves.h"
#include "study/stimulus.h"
#include "study/study_file.h"

/// Where on a tissue a study's stimuli lie: a stimulus is a place. Pure.
namespace palp::study {

/// A tissue of the study, and where it is. Of a search: where a ball's axis is.
struct TrayPlace {
  double level{};  ///< [-], as Stimulus has it
  Place place{};
};

/// Places of a grid, dealt out by the study's seed, so that where one lies tells nothing of how
/// stiff it is.
struct Tray {
  std::vector<TrayPlace> places{};  ///< of some levels more than one
  std::array<Place, 4> decoys{};    ///< beyond the grid's corners
};

/// All tasks but bias. What others are compared with lies at as many places as levels do, as far as
/// there is room for them; a tissue that is delayed at one for each interval. A sentence where
/// there is no room for the study's levels or depths.
[[nodiscard]] Result<Tray> make_tray(const Study& study);

/// The place of each interval of a trial, of a search the middle of its area.
[[nodiscard]] std::vector<Place> places_of(const Tray& tray,
                                           const Study& study,
                                           const TrialAsk& ask);
/// Of a search: where the ball of the trial lies.
[[nodiscard]] Place axis_of(const Tray& tray, double level);

/// The tissue as a file for palp-patient: a table of curves, between places what lies between; of a
/// search a block with all balls.
[[nodiscard]] std::string tissue_text(const Tray& tray,
                                      const Study& study,
                                      const LevelCurves& curves);

}  // namespace palp::study
