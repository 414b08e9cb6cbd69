#pragma once

#include <vector>

#include "common/core/map_doubt.h"
#include "depth/map_posterior.h"

namespace palp::depth {

/// What may be said of the touches as a whole.
struct MapVerdict {
  bool found{};                  ///< a ball is there
  std::vector<MapDoubt> doubts;  ///< none: its numbers may be trusted
  double worst_curve{};      ///< [-], standard deviations of a place's squares, beyond its curve's
  double worst_deviation{};  ///< [-], standard deviations of a place's stiffness
};

struct MapVerdictConfig {
  double evidence_min{2};    ///< [-], log of the odds from which there is a ball
  double gain_min{9};        ///< [-], and what the best one must gain: 3 sigma
  double curve_max{15};      ///< [-], see worst_curve
  double curve_share{0.02};  ///< [-], of the force, by which a curve may be off for want of terms
  double deviation_max{4};   ///< [-], see worst_deviation
  double worth_min{10};      ///< [-], of MapPosterior::balls_worth: fewer are no posterior
  double side_min{0.1};      ///< [-], share of a second mode
  double outside_max{0.25};  ///< [-], share beyond the touched places
};

[[nodiscard]] MapVerdict map_verdict(const MapLikelihood& likelihood,
                                     const MapPosterior& posterior,
                                     const MapVerdictConfig& config = {});

}  // namespace palp::depth
