#pragma once

namespace palp::fem {

/// Frictionless indentation of an elastic layer that is bonded to a rigid base and endless to the
/// sides, by a rigid sphere, small strain: the integral equation of Lebedev and Ufliand with the
/// kernel of Hayes, Keer, Herrmann and Mockros (J. Biomech. 5, 1972). What no mesh knows of.
struct BondedLayer {
  double height{};          ///< [m]
  double youngs_modulus{};  ///< [Pa]
  double poisson{};         ///< [-]
  double radius{};          ///< [m], of the sphere

  struct Answer {
    double indentation{};  ///< [m]
    double force{};        ///< [N]
  };
  /// For a contact of radius `contact` [m], below the sphere's.
  [[nodiscard]] Answer pressed_to(double contact) const;
  /// [N], at an indentation [m].
  [[nodiscard]] double force(double indentation) const;
};

}  // namespace palp::fem
