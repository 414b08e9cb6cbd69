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

/// What a touch there is expected to tell: half the logarithm of how much the balls that may be
/// disagree about its force, over what one touch leaves open (one tap of 4 mm, its surface
/// unknown, and the tissue's spread). [nat]
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
