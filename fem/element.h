#pragma once

#include <array>

#include "fem/material.h"
#include "fem/mesh.h"

namespace palp::fem {

/// Small: linear elasticity. Finite: neo-Hookean, total Lagrangian.
enum class Strain { Small, Finite };

/// Values of nine shape functions and their derivatives along xi and eta.
struct Shape {
  std::array<double, 9> value{};  ///< [-]
  std::array<double, 9> xi{};     ///< [-]
  std::array<double, 9> eta{};    ///< [-]
};
[[nodiscard]] Shape shape_at(double xi, double eta) noexcept;

/// Points and weights of the 3 x 3 rule, in the element's square.
struct QuadraturePoint {
  double xi{};      ///< [-]
  double eta{};     ///< [-]
  double weight{};  ///< [-]
};
[[nodiscard]] const std::array<QuadraturePoint, 9>& quadrature() noexcept;

/// What an element needs of its geometry, computed once.
struct ElementGeometry {
  struct Point {
    std::array<double, 9> dr{};        ///< [1/m], derivatives of the shape functions
    std::array<double, 9> dz{};        ///< [1/m]
    std::array<double, 9> hoop{};      ///< [1/m], N / r
    std::array<double, 3> pressure{};  ///< [-], 1, xi, eta
    double volume{};                   ///< [m^3], of the whole ring
  };
  std::array<Point, 9> points{};
  std::array<std::array<double, 3>, 3> mass_inverse{};  ///< [1/m^3], of the pressure's functions
};

/// The Jacobian must be positive at every point: a mesh that breaks it is our bug.
[[nodiscard]] ElementGeometry make_geometry(const Mesh& mesh, const Element& element);

/// Displacements of nine nodes: r of all, then z of all.
using ElementVector = std::array<double, 18>;
using ElementMatrix = std::array<std::array<double, 18>, 18>;

/// Coefficients of an element's pressure on 1, xi, eta; tension is positive. [Pa]
using Pressure = std::array<double, 3>;

struct ElementResponse {
  ElementVector force{};       ///< [N], derivative of the energy
  ElementMatrix tangent{};     ///< [N/m]; lower triangle and diagonal blocks are filled whole
  double energy{};             ///< [J]
  double volume_ratio_min{1};  ///< [-], not positive: the state is impossible, nothing else holds
};

/// Q2/P-1: biquadratic displacement, pressure linear and discontinuous, eliminated inside the
/// element (J is replaced by its projection on 1, xi, eta). Stable to the incompressible limit and
/// still a matrix in displacements alone.
[[nodiscard]] ElementResponse respond(const ElementGeometry& geometry,
                                      const Material& material,
                                      Strain strain,
                                      const ElementVector& displacement);

/// As respond() at finite strain, but the tangent is that of a pressure that is an unknown of its
/// own: Newton's method in both converges from much farther away, because a guess of the
/// displacements that changes the volume a little does not stiffen or soften the element. Force and
/// energy are those of the displacements alone.
[[nodiscard]] ElementResponse respond(const ElementGeometry& geometry,
                                      const Material& material,
                                      const ElementVector& displacement,
                                      const Pressure& pressure);

/// What the pressure becomes when `displacement` goes on by `step`, to first order.
[[nodiscard]] Pressure pressure_after(const ElementGeometry& geometry,
                                      const Material& material,
                                      const ElementVector& displacement,
                                      const ElementVector& step);

struct ElementForces {
  ElementVector force{};       ///< [N], derivative of the energy
  double energy{};             ///< [J]
  double volume_ratio_min{1};  ///< [-], not positive: the state is impossible
};
/// As respond() at finite strain, without the tangent.
[[nodiscard]] ElementForces internal_forces(const ElementGeometry& geometry,
                                            const Material& material,
                                            const ElementVector& displacement);

/// Energy alone; infinite where the state is impossible.
[[nodiscard]] double stored_energy(const ElementGeometry& geometry,
                                   const Material& material,
                                   const ElementVector& displacement);

/// F at point `point`.
[[nodiscard]] Gradient gradient_at(const ElementGeometry::Point& point,
                                   const ElementVector& displacement) noexcept;

}  // namespace palp::fem
