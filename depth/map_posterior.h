#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "depth/map_prior.h"

namespace palp::depth {

/// One coordinate of the ball as the touches leave it.
struct Estimated {
  double median{};  ///< [as the coordinate]
  double low{};     ///< [as the coordinate], 95 % interval
  double high{};    ///< [as the coordinate]
  double stddev{};  ///< [as the coordinate]
};

/// A ball that may be, and how likely it is among them.
struct LikelyBall {
  MapBall ball;
  double share{};  ///< [-], of all; together 1
};

/// A part of the plane where the ball may lie: touches along one line leave two.
struct MapMode {
  Place place;     ///< mean
  double share{};  ///< [-], of the posterior
};

/// What all touches together say of one ball.
struct MapPosterior {
  Estimated x;            ///< [m], of its axis
  Estimated y;            ///< [m]
  Estimated depth;        ///< [m], of its top
  Estimated radius;       ///< [m]
  Estimated ratio;        ///< [-]
  double covariance{};    ///< [m^2], of x and y
  double log_evidence{};  ///< [-], of a ball somewhere over none: the area is counted in
  double gain{};          ///< [-], twice the log-likelihood the best ball gains over none
  MapBall best;
  std::vector<MapMode> modes;     ///< the likeliest first
  std::vector<LikelyBall> balls;  ///< stands for all
  double balls_worth{};           ///< [-], so many even ones say as much
};

/// The posterior of (x, y, depth, radius, ratio). Radius and ratio are cells that are halved where
/// the posterior is heavy; in each, place and depth are a normal distribution round the best. From
/// these, and from the prior, balls are drawn, always the same, and weighed by the likelihood: what
/// is not normal comes right by the weights. A few thousand likelihoods, whatever the touches.
/// Thread: estimator.
[[nodiscard]] MapPosterior map_posterior(const MapLikelihood& likelihood,
                                         const BallField& field,
                                         const MapPrior& prior);

}  // namespace palp::depth
