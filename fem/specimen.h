#pragma once

#include <array>
#include <string_view>

#include "common/core/result.h"

/// What is pressed and with what. Axisymmetric: everything lies on the axis r = 0; z points up, the
/// free surface is z = 0, the base z = -height is bonded, the side is free.
namespace palp::fem {

/// Homogeneous, isotropic. Defaults: the paper's phantom (section II.B).
struct Block {
  double half_width{45e-3};       ///< [m]
  double height{57e-3};           ///< [m]
  double youngs_modulus{15.3e3};  ///< [Pa]
  double poisson{0.49};           ///< [-], below 0.5
};

enum class InclusionShape { None, Ball, Cylinder, Column };

[[nodiscard]] constexpr std::string_view to_string(InclusionShape shape) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"none", "ball", "cylinder", "column"};
  return kNames[static_cast<std::size_t>(shape)];
}

/// Bonded to the block on all sides. A column is a cylinder that reaches the base.
struct Inclusion {
  InclusionShape shape{InclusionShape::None};
  double depth{10e-3};            ///< [m], of its top below the surface
  double radius{15e-3};           ///< [m]
  double height{20e-3};           ///< [m], of a cylinder
  double ratio{13.1e6 / 15.3e3};  ///< [-], of Young's moduli, inclusion to block (paper II.B)
  double poisson{0.49};           ///< [-]
  /// [m], of its lowest point below the surface in a block of height `block_height` [m].
  [[nodiscard]] double bottom(double block_height) const noexcept;
};

enum class IndenterShape { Sphere, Paraboloid, FlatPunch, Cone };

/// Rigid, frictionless. The paper's: a round tip of 10 mm diameter.
struct Indenter {
  IndenterShape shape{IndenterShape::Sphere};
  double radius{5e-3};  ///< [m], of the sphere, of curvature, of the punch; of a cone's mesh
  double slope{0.1};    ///< [-], of a cone's flank
  /// Height of the tip's profile above its lowest point [m]; infinite beyond its rim. r in [m].
  [[nodiscard]] double profile(double r) const noexcept;
};

struct Specimen {
  Block block;
  Inclusion inclusion;
  Indenter indenter;
};

/// Whether it can be meshed and solved; else one sentence with the limit, in millimetre and kPa.
[[nodiscard]] Result<void> check(const Specimen& specimen);

}  // namespace palp::fem
