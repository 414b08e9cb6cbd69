#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/core/result.h"
#include "fem/harmonic_kernel.h"
#include "fem/sneddon_sphere.h"
#include "fem/specimen.h"
#include "fem/surface_patch.h"

namespace palp::fem {

/// Model L1 with the tip's axis beside the ball's. The surface sinks by
///   C(s, s') = half space (Love) + a constant of the block + dC(s, s'),
/// on square cells under the tip, a sphere. The constant makes the plain block as soft as the
/// axisymmetric solver finds it. The block's side counts as being as far as from its middle.
/// Thread: its owner's.
class OffAxisContact {
 public:
  /// For offsets up to `offset_max` [m], which offset_limit() permits. `specimen` has passed
  /// check(), with a ball or nothing inside.
  OffAxisContact(const Specimen& specimen, double offset_max, Accuracy accuracy);

  /// ln(F / F_plain) with F_plain without the ball. [-] The cells' own error leaves it: the plain
  /// block that gives the same force on the same cells says which depth without a ball the tip
  /// feels, and plain() says what forces belong to both depths. `indentation` > 0 [m]; `offset`
  /// between the axes, on either side [m].
  [[nodiscard]] Result<double> excess(double indentation, double offset);
  /// The tip on the plain block, on a dome (> 0) or in a hollow of `surface_curvature` [1/m].
  [[nodiscard]] SneddonSphere plain(double surface_curvature) const noexcept;

  /// What the block's size adds to each sinking. [m/N]
  [[nodiscard]] double block_constant() const noexcept { return block_constant_; }
  /// Of the ball's harmonics, see HarmonicKernel::last_share(). [-]
  [[nodiscard]] double last_share() const { return kernel_ ? kernel_->last_share() : 0; }

 private:
  [[nodiscard]] Result<SurfacePatch::Press> press(const Eigen::MatrixXd& compliance,
                                                  double indentation) const;
  /// At which the cells give `force` [N] without a ball, from a first guess. [m]
  [[nodiscard]] Result<double> plain_depth(double force, double guess) const;
  void move_to(double offset);

  Specimen specimen_;
  SurfacePatch patch_;
  double block_constant_;                 ///< [m/N]
  Eigen::MatrixXd plain_;                 ///< [m/N]
  std::optional<HarmonicKernel> kernel_;  ///< nothing without a ball
  std::optional<double> offset_;          ///< [m], of compliance_
  Eigen::MatrixXd compliance_;            ///< [m/N]
};

/// Farthest tip from the ball's axis: the cells keep clear of the block's side. [m]
[[nodiscard]] double offset_limit(const Specimen& specimen) noexcept;

}  // namespace palp::fem
