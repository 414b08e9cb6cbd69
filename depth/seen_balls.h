#pragma once

#include <vector>

#include "depth/ball_field.h"
#include "depth/map_posterior.h"

namespace palp::depth {

/// A ball that may be, as the forces above it see it.
struct SeenBall {
  MapBall ball;
  BallField::Ball effect;

  /// ln of the force at a place over that of plain tissue, 2.3 mm deep. [-]
  [[nodiscard]] double log_ratio(const Place& place) const noexcept;
};

/// Two hundred that stand for the posterior, each as likely as the others.
[[nodiscard]] std::vector<SeenBall> seen_balls(const BallField& field,
                                               const MapPosterior& posterior);

}  // namespace palp::depth
