#pragma once

#include <vector>

#include "common/message/map_report.h"
#include "depth/map_likelihood.h"
#include "depth/map_posterior.h"

namespace palp::depth {

/// What the posterior says of the whole touched area and 12 mm round it: how stiff it is and
/// whether an inclusion lies below, in cells of 2 mm or more, kMapSideMax along x and y at most.
/// A ball is there or none, as likely as the evidence says. Row by row, from the least y on.
[[nodiscard]] std::vector<MapCell> stiffness_map(const MapLikelihood& likelihood,
                                                 const BallField& field,
                                                 const MapPosterior& posterior);

}  // namespace palp::depth
