#pragma once

#include <vector>

#include <Eigen/Core>

#include "fem/cubic_spline.h"
#include "fem/mesh.h"
#include "fem/specimen.h"

namespace palp::fem {

/// A place on the surface, seen from the inclusion's axis.
struct SurfacePoint {
  double r{};    ///< [m]
  double phi{};  ///< [rad]
};

/// What an inclusion changes in the sinking of the surface: dC(s, s') = sinking at s under a unit
/// force at s', with the inclusion minus without it on the same mesh, so that the mesh's own error
/// and the kernel's singularity cancel. Small strain. A sum over harmonics
///   dC(s, s') = sum A_n(r, r') cos n (phi - phi'),
/// each a spline over surface nodes. A value. Thread: any.
class HarmonicKernel {
 public:
  /// For places no farther than `reach` [m] from the axis, which is below the half width.
  /// `specimen` has passed check() and holds a ball.
  HarmonicKernel(const Specimen& specimen, double reach, Accuracy accuracy);

  [[nodiscard]] int orders() const noexcept { return static_cast<int>(amplitudes_.size()); }
  [[nodiscard]] double reach() const noexcept { return knots_.back(); }  ///< [m]
  /// Radii of the surface nodes. [m]
  [[nodiscard]] const std::vector<double>& knots() const noexcept { return knots_; }
  /// Of one harmonic between surface nodes. [m/N]
  [[nodiscard]] const Eigen::MatrixXd& amplitude(int order) const {
    return amplitudes_[static_cast<std::size_t>(order)];
  }
  /// The largest amplitude of the last harmonic over that of the first: what is left out is less.
  [[nodiscard]] double last_share() const;  ///< [-]

  /// dC between all pairs of `points`. [m/N]
  [[nodiscard]] Eigen::MatrixXd between(const std::vector<SurfacePoint>& points) const;
  /// The same where each force is shared by a point and its image at -phi. [m/N]
  [[nodiscard]] Eigen::MatrixXd mirrored(const std::vector<SurfacePoint>& points) const;

 private:
  /// Weights of the knots, for even or odd harmonics.
  [[nodiscard]] Eigen::MatrixXd weights(const std::vector<SurfacePoint>& points, int order) const;

  std::vector<double> knots_;  ///< [m]
  std::vector<Eigen::MatrixXd> amplitudes_;
  std::vector<CubicSpline> splines_;  ///< even, odd
};

/// How many harmonics a ball needs: they fall as (a / (a + z))^(2 n) with its radius a and depth z.
[[nodiscard]] int harmonics_wanted(const Inclusion& ball);

}  // namespace palp::fem
