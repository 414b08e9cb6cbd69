#include "fem/element.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "common/core/check.h"
#include "common/core/matrix3.h"

namespace palp::fem {
namespace {

using Blocks = std::array<std::array<double, 9>, 9>;

Vector3 times(const Matrix3& m, const Vector3& v) {
  Vector3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  }
  return out;
}

/// Material state of all nine points, and the smoothed volume change.
struct State {
  std::array<Gradient, 9> gradients{};
  Vector3 dilation{};   ///< [-], coefficients of the projection of J - 1
  double volumetric{};  ///< [J/Pa], half of its square's integral
  double ratio_min{1};  ///< [-]
};

State state_of(const ElementGeometry& geometry, const ElementVector& u) {
  State state;
  Vector3 moments{};
  for (std::size_t p = 0; p < 9; ++p) {
    const ElementGeometry::Point& point = geometry.points[p];
    state.gradients[p] = gradient_at(point, u);
    const double ratio = volume_ratio(state.gradients[p]);
    state.ratio_min = std::min({state.ratio_min, ratio, state.gradients[p][4]});
    for (std::size_t k = 0; k < 3; ++k) {
      moments[k] += point.volume * point.pressure[k] * (ratio - 1);
    }
  }
  state.dilation = times(geometry.mass_inverse, moments);
  for (std::size_t k = 0; k < 3; ++k) state.volumetric += 0.5 * state.dilation[k] * moments[k];
  return state;
}

double pressure_at(const ElementGeometry::Point& point, const Pressure& coefficients) {
  double pressure = 0;
  for (std::size_t k = 0; k < 3; ++k) pressure += coefficients[k] * point.pressure[k];
  return pressure;
}

/// Adds w B^T A B, block by block: rr, zr (rows z, columns r), zz.
void add_tangent(const ElementGeometry::Point& point,
                 const GradientMatrix& a,
                 Blocks& rr,
                 Blocks& zr,
                 Blocks& zz) {
  const double w = point.volume;
  for (std::size_t i = 0; i < 9; ++i) {
    const double dr = w * point.dr[i];
    const double dz = w * point.dz[i];
    const double hoop = w * point.hoop[i];
    const double r0 = a[0][0] * dr + a[0][1] * dz + a[0][4] * hoop;
    const double r1 = a[1][0] * dr + a[1][1] * dz + a[1][4] * hoop;
    const double r4 = a[4][0] * dr + a[4][1] * dz + a[4][4] * hoop;
    const double z0 = a[2][0] * dr + a[2][1] * dz + a[2][4] * hoop;
    const double z1 = a[3][0] * dr + a[3][1] * dz + a[3][4] * hoop;
    const double s0 = a[2][2] * dr + a[2][3] * dz;
    const double s1 = a[3][2] * dr + a[3][3] * dz;
    for (std::size_t j = 0; j < 9; ++j) {
      rr[i][j] += r0 * point.dr[j] + r1 * point.dz[j] + r4 * point.hoop[j];
      zr[i][j] += z0 * point.dr[j] + z1 * point.dz[j];
      zz[i][j] += s0 * point.dr[j] + s1 * point.dz[j];
    }
  }
}

}  // namespace

Shape shape_at(double xi, double eta) noexcept {
  const auto line = [](double t) {
    return std::array<std::array<double, 3>, 2>{
        {{0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)}, {t - 0.5, -2 * t, t + 0.5}}};
  };
  const auto x = line(xi);
  const auto y = line(eta);
  Shape shape;
  for (std::size_t k = 0; k < 9; ++k) {
    shape.value[k] = x[0][k % 3] * y[0][k / 3];
    shape.xi[k] = x[1][k % 3] * y[0][k / 3];
    shape.eta[k] = x[0][k % 3] * y[1][k / 3];
  }
  return shape;
}

const std::array<QuadraturePoint, 9>& quadrature() noexcept {
  static const std::array<QuadraturePoint, 9> points = [] {
    const double x = std::sqrt(0.6);
    const std::array<double, 3> at{-x, 0, x};
    const std::array<double, 3> weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
    std::array<QuadraturePoint, 9> out{};
    for (std::size_t k = 0; k < 9; ++k) {
      out[k] = {at[k % 3], at[k / 3], weight[k % 3] * weight[k / 3]};
    }
    return out;
  }();
  return points;
}

ElementGeometry make_geometry(const Mesh& mesh, const Element& element) {
  ElementGeometry geometry;
  Matrix3 mass{};
  for (std::size_t p = 0; p < 9; ++p) {
    const QuadraturePoint& at = quadrature()[p];
    const Shape shape = shape_at(at.xi, at.eta);
    double r = 0;
    std::array<double, 4> jacobian{};
    for (std::size_t k = 0; k < 9; ++k) {
      const Node& node = mesh.nodes[static_cast<std::size_t>(element.nodes[k])];
      r += shape.value[k] * node.r;
      jacobian[0] += shape.xi[k] * node.r;
      jacobian[1] += shape.xi[k] * node.z;
      jacobian[2] += shape.eta[k] * node.r;
      jacobian[3] += shape.eta[k] * node.z;
    }
    const double det = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2];
    PALP_CHECK(det > 0 && r > 0, "an element of the mesh is turned inside out");
    ElementGeometry::Point& point = geometry.points[p];
    point.volume = 2 * std::numbers::pi * r * det * at.weight;
    point.pressure = {1, at.xi, at.eta};
    for (std::size_t k = 0; k < 9; ++k) {
      point.dr[k] = (jacobian[3] * shape.xi[k] - jacobian[1] * shape.eta[k]) / det;
      point.dz[k] = (jacobian[0] * shape.eta[k] - jacobian[2] * shape.xi[k]) / det;
      point.hoop[k] = shape.value[k] / r;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        mass[i][j] += point.volume * point.pressure[i] * point.pressure[j];
      }
    }
  }
  geometry.mass_inverse = inverse(mass).matrix;
  return geometry;
}

Gradient gradient_at(const ElementGeometry::Point& point, const ElementVector& u) noexcept {
  Gradient f = kUndeformed;
  for (std::size_t k = 0; k < 9; ++k) {
    f[0] += point.dr[k] * u[k];
    f[1] += point.dz[k] * u[k];
    f[2] += point.dr[k] * u[k + 9];
    f[3] += point.dz[k] * u[k + 9];
    f[4] += point.hoop[k] * u[k];
  }
  return f;
}

double stored_energy(const ElementGeometry& geometry,
                     const Material& material,
                     const ElementVector& displacement) {
  const State state = state_of(geometry, displacement);
  if (!(state.ratio_min > 0)) return std::numeric_limits<double>::infinity();
  double energy = material.bulk() * state.volumetric;
  for (std::size_t p = 0; p < 9; ++p) {
    const Gradient& f = state.gradients[p];
    double i1 = 0;
    for (const double component : f) i1 += component * component;
    const double cube = std::cbrt(volume_ratio(f));
    energy += geometry.points[p].volume * 0.5 * material.shear() * (i1 / (cube * cube) - 3);
  }
  return energy;
}

ElementForces internal_forces(const ElementGeometry& geometry,
                              const Material& material,
                              const ElementVector& displacement) {
  ElementForces out;
  const State state = state_of(geometry, displacement);
  out.volume_ratio_min = state.ratio_min;
  if (!(state.ratio_min > 0)) return out;
  out.energy = material.bulk() * state.volumetric;
  Pressure own = state.dilation;
  for (double& coefficient : own) coefficient *= material.bulk();
  for (std::size_t p = 0; p < 9; ++p) {
    const ElementGeometry::Point& point = geometry.points[p];
    const Gradient& f = state.gradients[p];
    const Gradient c = cofactor(f);
    const double pressure = pressure_at(point, own);
    const double j = volume_ratio(f);
    double i1 = 0;
    for (const double component : f) i1 += component * component;
    const double cube = std::cbrt(j);
    const double scale = material.shear() / (cube * cube);
    out.energy += point.volume * 0.5 * (scale * i1 - 3 * material.shear());
    Gradient stress{};
    for (std::size_t i = 0; i < 5; ++i) {
      stress[i] = point.volume * (scale * f[i] + (pressure - scale * i1 / (3 * j)) * c[i]);
    }
    for (std::size_t i = 0; i < 9; ++i) {
      out.force[i] += stress[0] * point.dr[i] + stress[1] * point.dz[i] + stress[4] * point.hoop[i];
      out.force[i + 9] += stress[2] * point.dr[i] + stress[3] * point.dz[i];
    }
  }
  return out;
}

namespace {

/// What the points of an element add up to: blocks of the stiffness at constant volume, and the
/// derivative of the moments of J.
struct Sums {
  Blocks rr{};
  Blocks zr{};
  Blocks zz{};
  std::array<ElementVector, 3> squeeze{};
};

void add_squeeze(const ElementGeometry::Point& point,
                 const Gradient& c,
                 std::array<ElementVector, 3>& squeeze) {
  for (std::size_t i = 0; i < 9; ++i) {
    const double r =
        point.volume * (c[0] * point.dr[i] + c[1] * point.dz[i] + c[4] * point.hoop[i]);
    const double z = point.volume * (c[2] * point.dr[i] + c[3] * point.dz[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      squeeze[k][i] += point.pressure[k] * r;
      squeeze[k][i + 9] += point.pressure[k] * z;
    }
  }
}

void add_force(const ElementGeometry::Point& point, const Gradient& stress, ElementVector& force) {
  for (std::size_t i = 0; i < 9; ++i) {
    force[i] += point.volume *
                (stress[0] * point.dr[i] + stress[1] * point.dz[i] + stress[4] * point.hoop[i]);
    force[i + 9] += point.volume * (stress[2] * point.dr[i] + stress[3] * point.dz[i]);
  }
}

/// The blocks, and what the pressure adds where it follows the volume.
void fill_tangent(const Sums& sums,
                  const ElementGeometry& geometry,
                  double bulk,
                  ElementMatrix& tangent) {
  const auto& [rr, zr, zz, squeeze] = sums;
  for (std::size_t i = 0; i < 18; ++i) {
    Vector3 scaled = times(geometry.mass_inverse, {squeeze[0][i], squeeze[1][i], squeeze[2][i]});
    for (double& value : scaled) value *= bulk;
    for (std::size_t j = 0; j < 18; ++j) {
      const double elastic =
          i < 9 ? (j < 9 ? rr[i][j] : zr[i][j - 9]) : (j < 9 ? zr[j][i - 9] : zz[i - 9][j - 9]);
      tangent[i][j] = elastic + scaled[0] * squeeze[0][j] + scaled[1] * squeeze[1][j] +
                      scaled[2] * squeeze[2][j];
    }
  }
}

/// Small strains: the undeformed element's tangent holds everywhere.
void follow_tangent(const ElementVector& displacement, ElementResponse& out) {
  out.energy = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    out.force[i] = 0;
    for (std::size_t j = 0; j < 18; ++j) out.force[i] += out.tangent[i][j] * displacement[j];
    out.energy += 0.5 * out.force[i] * displacement[i];
  }
}

/// `given`: the pressure of the tangent, if not the displacements' own.
ElementResponse response(const ElementGeometry& geometry,
                         const Material& material,
                         Strain strain,
                         const ElementVector& displacement,
                         const Pressure* given) {
  ElementResponse out;
  const bool finite = strain == Strain::Finite;
  const State state = state_of(geometry, finite ? displacement : ElementVector{});
  out.volume_ratio_min = state.ratio_min;
  if (!(state.ratio_min > 0)) return out;
  const double bulk = material.bulk();
  out.energy = bulk * state.volumetric;
  Pressure own = state.dilation;
  for (double& coefficient : own) coefficient *= bulk;
  Sums sums;
  for (std::size_t p = 0; p < 9; ++p) {
    const ElementGeometry::Point& point = geometry.points[p];
    const Gradient& f = state.gradients[p];
    Isochoric part = isochoric(f, material.shear());
    const Gradient c = cofactor(f);
    out.energy += point.volume * part.energy;
    if (finite) {
      const double pressure = pressure_at(point, own);
      const double bending = given != nullptr ? pressure_at(point, *given) : pressure;
      const GradientMatrix h = volume_curvature(f);
      for (std::size_t i = 0; i < 5; ++i) {
        part.stress[i] += pressure * c[i];
        for (std::size_t j = 0; j < 5; ++j) part.tangent[i][j] += bending * h[i][j];
      }
    }
    add_tangent(point, part.tangent, sums.rr, sums.zr, sums.zz);
    add_squeeze(point, c, sums.squeeze);
    add_force(point, part.stress, out.force);
  }
  fill_tangent(sums, geometry, bulk, out.tangent);
  if (!finite) follow_tangent(displacement, out);
  return out;
}

}  // namespace

ElementResponse respond(const ElementGeometry& geometry,
                        const Material& material,
                        Strain strain,
                        const ElementVector& displacement) {
  return response(geometry, material, strain, displacement, nullptr);
}

ElementResponse respond(const ElementGeometry& geometry,
                        const Material& material,
                        const ElementVector& displacement,
                        const Pressure& pressure) {
  return response(geometry, material, Strain::Finite, displacement, &pressure);
}

Pressure pressure_after(const ElementGeometry& geometry,
                        const Material& material,
                        const ElementVector& displacement,
                        const ElementVector& step) {
  Vector3 moments{};
  for (const ElementGeometry::Point& point : geometry.points) {
    const Gradient f = gradient_at(point, displacement);
    const Gradient c = cofactor(f);
    const Gradient df = gradient_at(point, step);
    double change = volume_ratio(f) - 1;
    for (std::size_t i = 0; i < 5; ++i) change += c[i] * (df[i] - kUndeformed[i]);
    for (std::size_t k = 0; k < 3; ++k) moments[k] += point.volume * point.pressure[k] * change;
  }
  Pressure pressure = times(geometry.mass_inverse, moments);
  for (double& value : pressure) value *= material.bulk();
  return pressure;
}

}  // namespace palp::fem
