#pragma once

#include <cstddef>
#include <vector>

#include "depth/map_likelihood.h"

namespace palp::depth {

/// Where a ball is looked for: what DepthPrior says, below every point within `reach` of a touched
/// place, evenly.
struct MapPrior {
  DepthPrior ball;
  double reach{15e-3};         ///< [m]
  double block_height{57e-3};  ///< [m], a ball lies within
};

/// Evenly spread numbers in [0, 1): the radical inverse of a whole number in a prime base.
[[nodiscard]] double even_number(std::size_t index, std::size_t base) noexcept;

/// The prior of one set of touched places. A value. Thread: any.
class BallPrior {
 public:
  /// At least one place.
  BallPrior(const MapPrior& prior, const std::vector<PlaceData>& places);

  /// Of so many touched places `place` is within reach; 0: no ball is there.
  [[nodiscard]] std::size_t covering(const Place& place) const noexcept;
  /// Density in (x, y, log depth, radius, log ratio), logarithm, but for total(). Minus infinity:
  /// no such ball.
  [[nodiscard]] double log_density(const MapBall& ball) const noexcept;
  /// Its integral, logarithm.
  [[nodiscard]] double log_total() const noexcept { return log_total_; }

  /// A ball of a sequence that fills the prior evenly, and how dense the sequence is there.
  /// `rank` [-] in [0, 1) says the depth.
  [[nodiscard]] MapBall draw(std::size_t index, double rank) const noexcept;
  [[nodiscard]] double draw_density(const MapBall& ball) const noexcept;

  /// Logarithm of the deepest top [m] of a ball of this radius [m].
  [[nodiscard]] double log_deepest(double radius) const noexcept;

  [[nodiscard]] const MapPrior& given() const noexcept { return prior_; }
  [[nodiscard]] double log_depth_low() const noexcept { return log_depth_low_; }
  [[nodiscard]] double log_depth_high() const noexcept { return log_depth_high_; }
  [[nodiscard]] double radius_width() const noexcept { return radius_width_; }  ///< [m]
  [[nodiscard]] double log_ratio_low() const noexcept { return log_ratio_low_; }
  [[nodiscard]] double log_ratio_width() const noexcept { return log_ratio_width_; }

 private:
  [[nodiscard]] double area() const noexcept;

  MapPrior prior_;
  std::vector<Place> places_;
  double log_depth_low_{};    ///< [-]
  double log_depth_high_{};   ///< [-]
  double radius_width_{};     ///< [m]
  double log_ratio_low_{};    ///< [-]
  double log_ratio_width_{};  ///< [-]
  double log_area_{};         ///< [-]
  double log_total_{};        ///< [-]
};

/// Of a coordinate that is known exactly: its width, so that it has a density.
inline constexpr double kNoWidth = 1e-12;

}  // namespace palp::depth
