#pragma once

#include <array>

namespace palp::fem {

/// Isotropic elasticity by Young's modulus and Poisson's ratio.
struct Material {
  double youngs_modulus{};  ///< [Pa]
  double poisson{};         ///< [-]
  [[nodiscard]] double shear() const noexcept { return youngs_modulus / (2 * (1 + poisson)); }
  [[nodiscard]] double bulk() const noexcept { return youngs_modulus / (3 * (1 - 2 * poisson)); }
};

/// The five components of an axisymmetric deformation gradient (or of a stress that is work
/// conjugate to it): rr, rz, zr, zz, and the hoop component.
using Gradient = std::array<double, 5>;
using GradientMatrix = std::array<std::array<double, 5>, 5>;

inline constexpr Gradient kUndeformed{1, 0, 0, 1, 1};

/// det F, its derivative (the cofactor) and its second derivative.
[[nodiscard]] double volume_ratio(const Gradient& f) noexcept;
[[nodiscard]] Gradient cofactor(const Gradient& f) noexcept;
[[nodiscard]] GradientMatrix volume_curvature(const Gradient& f) noexcept;

/// The part of a compressible neo-Hookean solid that keeps the volume:
/// W = mu/2 (J^(-2/3) tr(F^T F) - 3). The other part, K/2 (J - 1)^2, belongs to the element, which
/// smooths J. At F = 1 both together are Hooke's law.
struct Isochoric {
  double energy{};           ///< [J/m^3]
  Gradient stress{};         ///< [Pa], first Piola-Kirchhoff: dW/dF
  GradientMatrix tangent{};  ///< [Pa], d2W/dF2
};
[[nodiscard]] Isochoric isochoric(const Gradient& f, double shear) noexcept;

}  // namespace palp::fem
