#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "common/core/matrix3.h"
#include "depth/map_prior.h"

namespace palp::depth {

/// A cell of radius and ratio, with a normal distribution of place and depth in it.
struct BallCell {
  double radius{};                                         ///< [m]
  double radius_width{};                                   ///< [m]
  double log_ratio{};                                      ///< [-]
  double ratio_width{};                                    ///< [-]
  Vector3 best{};                                          ///< x, y [m], log depth
  double value{-std::numeric_limits<double>::infinity()};  ///< [-], likelihood and prior, logarithm
  Matrix3 covariance{};
  Matrix3 root{};       ///< its lower triangle: covariance = root root'
  double volume{};      ///< [-], log of sqrt(det(2 pi covariance))
  Vector3 by_radius{};  ///< how the best moves
  Vector3 by_ratio{};
  double radius_reach{};  ///< [-], standard deviations to the cell's edge
  double ratio_reach{};   ///< [-]
  double mass{};          ///< [-], logarithm, then share
  std::size_t mode{};

  /// Of place and log depth, where the cell's best moves to.
  [[nodiscard]] Vector3 middle(double at_radius, double at_log_ratio) const noexcept;
  [[nodiscard]] bool holds(const MapBall& ball) const noexcept;
  /// A draw by three normal numbers and one of chi^2 with four degrees of freedom: Student's.
  [[nodiscard]] MapBall draw(double at_radius,
                             double at_log_ratio,
                             const Vector3& normal,
                             double chi_square) const noexcept;
  /// Density of such draws at a ball the cell holds, radius and ratio even in it, logarithm.
  [[nodiscard]] double log_density(const MapBall& ball) const noexcept;
};

inline constexpr std::size_t kModesMax = 4;

/// Cells over all of radius and ratio, round each of the places (kModesMax at most) where a ball
/// explains the touches best; halved where the posterior is heavy.
[[nodiscard]] std::vector<BallCell> ball_cells(const MapLikelihood& likelihood,
                                               const BallField& field,
                                               const BallPrior& prior);

}  // namespace palp::depth
