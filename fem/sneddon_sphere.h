#pragma once

namespace palp::fem {

/// A rigid frictionless sphere on an elastic half space, small strain, Signorini contact: closed
/// solution of Sneddon (Int. J. Eng. Sci. 3, 1965). His integrals are linear in the profile, so the
/// surface may be a parabola of its own, a dome or a hollow, at the same contact radius. A block of
/// finite size sinks as a whole by `constant` times the force more. A value. Thread: any.
struct SneddonSphere {
  double radius{};             ///< [m]
  double modulus{};            ///< [Pa], E / (1 - nu^2)
  double surface_curvature{};  ///< [1/m], > 0: a dome; above -1 / radius
  double constant{};           ///< [m/N], above -1 / (2 modulus radius)

  struct Press {
    double force{};           ///< [N]
    double contact_radius{};  ///< [m]
  };
  /// `indentation` >= 0 [m].
  [[nodiscard]] Press press(double indentation) const noexcept;

 private:
  [[nodiscard]] double force_at(double contact_radius) const noexcept;
  [[nodiscard]] double indentation_at(double contact_radius) const noexcept;
};

}  // namespace palp::fem
