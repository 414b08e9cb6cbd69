#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "common/core/result.h"

namespace palp::fem {

/// Sinking at (x, y) of a half space under a pressure of 1 on the square |x| < half, |y| < half,
/// times E / (1 - nu^2). [m] Love 1929; Johnson, Contact Mechanics, eq. (3.25), over pi.
[[nodiscard]] double love_sinking(double x, double y, double half) noexcept;

/// The surface under a tip as square cells of even pressure, in a disc round the tip's axis. What
/// presses is the same at y and -y, so a cell stands for its image as well: forces are of both
/// together. Small strain, frictionless. A value. Thread: any.
class SurfacePatch {
 public:
  struct Cell {
    double x{};  ///< [m], from the tip's axis
    double y{};  ///< [m], 0 or more
  };
  struct Press {
    double force{};  ///< [N]
    double area{};   ///< [m^2], of the cells in contact
  };

  /// `radius` of the disc and side `cell` of the squares [m].
  SurfacePatch(double radius, double cell);

  [[nodiscard]] const std::vector<Cell>& cells() const noexcept { return cells_; }
  /// Sinking of the cells under unit forces on them, of a half space of E / (1 - nu^2) = `modulus`
  /// [Pa]. [m/N]
  [[nodiscard]] Eigen::MatrixXd half_space(double modulus) const;

  /// Signorini's problem of a rigid tip whose lowest point would be `indentation` [m] below the
  /// undeformed surface: sinking >= indentation - profile(r), force >= 0, one of them exactly.
  /// `compliance` [m/N] is symmetric positive definite. An error where the contact reaches the
  /// disc's rim.
  [[nodiscard]] Result<Press> press(const Eigen::MatrixXd& compliance,
                                    const std::function<double(double r)>& profile,
                                    double indentation) const;

 private:
  double radius_;  ///< [m]
  double cell_;    ///< [m]
  std::vector<Cell> cells_;
  std::vector<int> columns_;  ///< of each cell: x and y in cells
  std::vector<int> rows_;
};

}  // namespace palp::fem
