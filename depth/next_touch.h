#pragma once

#include <optional>
#include <vector>

#include "depth/map_posterior.h"

namespace palp::depth {

/// Where one more touch tells how much.
struct NextTouch {
  Place place;
  double gain{};  ///< [nat], expected information about the ball; >= 0
};

/// What a touch there is expected to tell of the ball: the mutual information of the two. Each ball
/// that may be foretells the force under each guess of the tissue's own stiffness, as likely as the
/// touches make it. A touch beside the ball tells too where only even tissue leaves that ball in
/// doubt. 0 where it was touched before: what the ball's model is off there, it is off again. [nat]
[[nodiscard]] double touch_gain(const MapLikelihood& likelihood,
                                const BallField& field,
                                const MapPosterior& posterior,
                                const Place& place);

/// The best of places round the touched ones and round the ball, 4 mm apart; a suggestion. `travel`
/// [m]: places lie no farther than that from the middle of the stage's plane, along x and y.
[[nodiscard]] std::optional<NextTouch> next_touch(const MapLikelihood& likelihood,
                                                  const BallField& field,
                                                  const MapPosterior& posterior,
                                                  double travel);

}  // namespace palp::depth
