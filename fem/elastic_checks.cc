#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "fem/dense_solver.h"
#include "fem/mapped_body.h"
#include "fem/verification.h"

namespace palp::fem {
namespace {

using std::numbers::pi;
constexpr double kYoungsModulus = 1000;  // [Pa], of every body here

std::string with_poisson(const std::string& law, double poisson) {
  char text[32];
  std::snprintf(text, sizeof text, ", nu %.6g", poisson);
  return law + text;
}

Vector2 no_displacement(const Node& /*place*/) { return {}; }

/// A square beside the axis, its lines bent: no element is a rectangle.
Node bent_square(double s, double t) {
  const double wave = 0.05 * std::sin(pi * s) * std::sin(pi * t);
  return {1 + s + wave, t + 1.3 * wave};
}

// Constant strain must come out exactly on any mesh: u_r = a r, u_z = b z.
void add_patch_test(Checks& to) {
  constexpr double kPoisson = 0.4999;
  const VectorField exact = [](const Node& at) { return Vector2{0.01 * at.r, -0.03 * at.z}; };
  const Material material{kYoungsModulus, kPoisson};
  const double pressure = (material.bulk() - 2 * material.shear() / 3) * (0.02 - 0.03);
  for (const bool pulled : {false, true}) {
    MappedBody body{4, 4, bent_square, material};
    for (const Side side : {Side::SLow, Side::SHigh, Side::TLow}) body.support(side, exact);
    if (pulled) {
      body.pull(Side::THigh, [&](const Node& /*place*/) {
        return Vector2{0, pressure + 2 * material.shear() * -0.03};
      });
    } else {
      body.support(Side::THigh, exact);
    }
    const auto found = body.solve(Strain::Small);
    const auto gradient = [](const Node& /*place*/) { return Gradient{0.01, 0, 0, -0.03, 0.01}; };
    const std::string law = with_poisson("patch test, constant strain on bent elements", kPoisson);
    const auto error = body.error_of(found.displacement, exact, gradient);
    to.push_back(
        {law, pulled ? "displacement, one side pulled" : "displacement", error.l2, 0, 1e-9});
    to.push_back({law, pulled ? "strain, one side pulled" : "strain", error.h1, 0, 1e-8});
  }
}

// An element has one motion without energy, the lift along the axis; no other zero mode.
void add_free_motions(Checks& to) {
  const MappedBody body{1, 1, bent_square, {kYoungsModulus, 0.4999}};
  const ElementGeometry geometry = make_geometry(body.mesh(), body.mesh().elements[0]);
  const ElementResponse at = respond(geometry, body.material(), Strain::Small, {});
  Eigen::MatrixXd stiffness(18, 18);
  for (int i = 0; i < 18; ++i) {
    for (int j = 0; j < 18; ++j) {
      stiffness(i, j) = at.tangent[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  const Eigen::VectorXd values = spectrum_of(stiffness).values;
  int count = 0;
  for (const double value : values) count += value < 1e-9 * values[17] ? 1 : 0;
  to.push_back({"one element, nu 0.4999", "motions without energy", double(count), 1, 0});
}

/// u_r = -r e^(-r^2) cos z, u_z = 2 (1 - r^2) e^(-r^2) sin z: smooth, and of no divergence, so that
/// the stress stays finite at any Poisson's ratio.
struct SmoothField {
  double shear{};  ///< [Pa]
  [[nodiscard]] Vector2 displacement(const Node& at) const {
    const double bell = std::exp(-at.r * at.r);
    return {-at.r * bell * std::cos(at.z), 2 * (1 - at.r * at.r) * bell * std::sin(at.z)};
  }
  [[nodiscard]] Gradient gradient(const Node& at) const {
    const double bell = std::exp(-at.r * at.r);
    const double square = at.r * at.r;
    return {-(1 - 2 * square) * bell * std::cos(at.z),
            at.r * bell * std::sin(at.z),
            2 * (2 * square - 4) * at.r * bell * std::sin(at.z),
            2 * (1 - square) * bell * std::cos(at.z),
            -bell * std::cos(at.z)};
  }
  /// Minus the divergence of the stress: of the vector Laplacian alone.
  [[nodiscard]] Vector2 body_force(const Node& at) const {
    const double bell = std::exp(-at.r * at.r);
    const double s = at.r * at.r;
    return {shear * bell * std::cos(at.z) * at.r * (4 * s - 9),
            -2 * shear * bell * std::sin(at.z) * (-4 * s * s + 17 * s - 9)};
  }
  [[nodiscard]] Vector2 traction_above(const Node& at) const {
    const Gradient g = gradient(at);
    return {shear * (g[1] + g[2]), 2 * shear * g[3]};
  }
};

void add_made_up_field(Checks& to, Extent extent) {
  for (const double poisson : {0.3, 0.49, 0.49999}) {
    const Material material{kYoungsModulus, poisson};
    const SmoothField field{material.shear()};
    const VectorField exact = [&](const Node& at) { return field.displacement(at); };
    std::array<MappedBody::Error, 2> errors;
    const int finest = extent == Extent::Quick ? 16 : 32;
    for (const std::size_t pass : {std::size_t{0}, std::size_t{1}}) {
      const int count = pass == 0 ? finest / 2 : finest;
      MappedBody body{count,
                      count,
                      [](double s, double t) {
                        const double wave = 0.06 * std::sin(pi * s) * std::sin(pi * t);
                        return Node{s + wave, t - wave};
                      },
                      material};
      body.support_r(Side::SLow, no_displacement);  // the axis
      body.support(Side::SHigh, exact);
      body.support(Side::TLow, exact);
      body.pull(Side::THigh, [&](const Node& at) { return field.traction_above(at); });
      body.fill([&](const Node& at) { return field.body_force(at); });
      errors[pass] = body.error_of(body.solve(Strain::Small).displacement,
                                   exact,
                                   [&](const Node& at) { return field.gradient(at); });
    }
    const std::string law = with_poisson("made-up smooth field", poisson);
    to.push_back(order(law, "displacement (L2)", errors[0].l2, errors[1].l2, 2, 3));
    to.push_back(order(law, "strain (H1)", errors[0].h1, errors[1].h1, 2, 2));
  }
}

// MacNeal and Harder's thick cylinder: radii 3 and 9, pressure 1 inside, plane strain.
void add_thick_cylinder(Checks& to) {
  for (const double poisson : {0.3, 0.49, 0.499, 0.4999, 0.49999}) {
    MappedBody body{6,
                    1,
                    [](double s, double t) {
                      return Node{3 * std::pow(3.0, s), t};
                    },
                    {kYoungsModulus, poisson}};
    body.support_z(Side::TLow, no_displacement);
    body.support_z(Side::THigh, no_displacement);
    body.pull(Side::SLow, [](const Node& /*place*/) { return Vector2{1, 0}; });
    const auto found = body.solve(Strain::Small);
    const double wanted =
        (1 + poisson) * 9 / (kYoungsModulus * 72) * (81.0 / 3 + (1 - 2 * poisson) * 3);
    to.push_back(close(with_poisson("thick cylinder under pressure (Lame)", poisson),
                       "inner displacement m",
                       found.displacement[r_of(body.nodes_of(Side::SLow)[1])],
                       wanted,
                       1e-3));
  }
}

/// Half of a hollow sphere, from the axis (s = 0) to the equator.
Placement shell(double inner, double outer) {
  return [=](double s, double t) {
    const double radius = inner * std::pow(outer / inner, t);
    const double angle = 0.5 * pi * s;
    return Node{s == 0 ? 0 : radius * std::sin(angle), s == 1 ? 0 : radius * std::cos(angle)};
  };
}

void add_thick_sphere(Checks& to, Extent extent) {
  for (const double poisson : {0.3, 0.49, 0.4999, 0.49999}) {
    const VectorField exact = [&](const Node& at) {
      const double r = std::hypot(at.r, at.z);
      const double u =
          1 / (kYoungsModulus * 26) * ((1 - 2 * poisson) * r + (1 + poisson) * 27 / (2 * r * r));
      return Vector2{u * at.r / r, u * at.z / r};
    };
    std::array<double, 2> errors{};
    const int finest = extent == Extent::Quick ? 8 : 16;
    for (const std::size_t pass : {std::size_t{0}, std::size_t{1}}) {
      const int count = pass == 0 ? finest / 2 : finest;
      MappedBody body{count, count, shell(1, 3), {kYoungsModulus, poisson}};
      body.support_r(Side::SLow, no_displacement);
      body.support_z(Side::SHigh, no_displacement);
      body.pull(Side::TLow, [](const Node& at) {
        const double r = std::hypot(at.r, at.z);
        return Vector2{at.r / r, at.z / r};
      });
      const auto found = body.solve(Strain::Small);
      errors[pass] = body.error_of(found.displacement,
                                   exact,
                                   [](const Node& /*place*/) {
                                     return Gradient{1, 0, 0, 0, 0};
                                   })
                         .l2;
    }
    const std::string law = with_poisson("thick sphere under pressure (Lame)", poisson);
    to.push_back({law, "displacement, relative error", errors[1], 0, 1e-3});
    to.push_back(order(law, "displacement (L2)", errors[0], errors[1], 2, 3));
  }
}

/// Outside a ball of radius 1 in an unbounded matrix under a far strain of diag(-1/2, -1/2, 1):
/// E x + p ((2 - 4 nu) E x / R^3 + 3 x (x E x) / R^5) + 3 p / 5 (2 E x / R^5 - 5 x (x E x) / R^7),
/// the decaying fields of Papkovich and Neuber that fit a strain s E inside.
Vector2 around_ball(const Node& at, double poisson, double inside) {
  const double p = (inside - 1) / (3.2 - 4 * poisson);
  const double square = at.r * at.r + at.z * at.z;
  const double radius = std::sqrt(square);
  const double cube = radius * square;
  const double form = at.z * at.z - 0.5 * at.r * at.r;
  const double strain = 1 + p * (2 - 4 * poisson) / cube + 1.2 * p / (cube * square);
  const double radial = 3 * p * form / (cube * square) - 3 * p * form / (cube * square * square);
  return {-0.5 * strain * at.r + radial * at.r, strain * at.z + radial * at.z};
}

// Eshelby: the strain in a ball in an unbounded matrix under uniform strain is uniform.
void add_ball_in_matrix(Checks& to) {
  for (const auto& [ratio, poisson] : {std::pair{10.0, 0.3}, {1000.0, 0.49}, {0.1, 0.4999}}) {
    const double beta = 2 * (4 - 5 * poisson) / (15 * (1 - poisson));
    const double inside = 1 / (1 + beta * (ratio - 1));
    // Two bodies in one lattice: a core that is a small ball, then rings up to three radii.
    MappedBody body{
        10,
        24,
        [](double s, double t) {
          const double radius = t < 0.5 ? 0.05 + 1.9 * t : std::pow(3.0, 2 * t - 1);
          const double angle = 0.5 * pi * s;
          return Node{s == 0 ? 0 : radius * std::sin(angle), s == 1 ? 0 : radius * std::cos(angle)};
        },
        {kYoungsModulus, poisson}};
    body.embed({kYoungsModulus * ratio, poisson},
               [](const Node& at) { return std::hypot(at.r, at.z) < 1; });
    const auto uniform = [inside = inside](const Node& at) {
      return Vector2{-0.5 * inside * at.r, inside * at.z};
    };
    body.support_r(Side::SLow, no_displacement);
    body.support_z(Side::SHigh, no_displacement);
    body.support(Side::TLow, uniform);
    body.support(Side::THigh, [poisson = poisson, inside = inside](const Node& at) {
      return around_ball(at, poisson, inside);
    });
    const auto found = body.solve(Strain::Small);
    char law[64];
    std::snprintf(law, sizeof law, "ball in a matrix (Eshelby), ratio %g", ratio);
    // Half way to the rim, on the axis, between and on the equator.
    const int width = 21;
    for (const auto& [place, name] : {std::pair{0, "axis"}, {10, "45 degrees"}, {20, "equator"}}) {
      const Gradient f = body.gradient_at(found.displacement, 12 * width + place);
      to.push_back(close(with_poisson(law, poisson),
                         std::string{"strain inside, "} + name,
                         f[3] - 1,
                         inside,
                         1e-3));
    }
  }
}

// A rigid ball pushed through a matrix: F = 24 pi mu a u (1 - nu) / (5 - 6 nu).
void add_pushed_ball(Checks& to) {
  for (const double poisson : {0.3, 0.49, 0.4999}) {
    const double a = 3 / (10 - 12 * poisson);
    const VectorField exact = [&](const Node& at) {
      const double square = at.r * at.r + at.z * at.z;
      const double radius = std::sqrt(square);
      const double cube = radius * square;
      const double along = a * at.z * (1 / cube - 1 / (cube * square));
      return Vector2{along * at.r, a * (3 - 4 * poisson) / radius + a / (3 * cube) + along * at.z};
    };
    MappedBody body{10, 14, shell(1, 4), {kYoungsModulus, poisson}};
    body.support_r(Side::SLow, no_displacement);
    body.support_r(Side::SHigh, no_displacement);
    body.support(Side::TLow, exact);
    body.support(Side::THigh, exact);
    const auto found = body.solve(Strain::Small);
    double force = 0;
    for (const int node : body.nodes_of(Side::TLow)) force += 2 * found.reaction[z_of(node)];
    const double wanted = 24 * pi * body.material().shear() * (1 - poisson) / (5 - 6 * poisson);
    to.push_back(close(with_poisson("rigid ball pushed through a matrix", poisson),
                       "force N",
                       force,
                       wanted,
                       1e-3));
  }
}

// Goodier: a spherical cavity in a bar under tension 1 raises the stress at its equator.
void add_cavity(Checks& to, Extent extent) {
  constexpr double kPoisson = 0.3;
  const Material material{kYoungsModulus, kPoisson};
  const double beta = 2 * (4 - 5 * kPoisson) / (15 * (1 - kPoisson));
  const double strain = (1 + kPoisson) / (1.5 * kYoungsModulus);  // deviator along the axis
  const double swelling = (1 - 2 * kPoisson) / (3 * kYoungsModulus);
  const VectorField exact = [&](const Node& at) {
    const Vector2 shape = around_ball(at, kPoisson, 1 / (1 - beta));
    const double radius = std::hypot(at.r, at.z);
    const double grown =
        swelling * (1 + (1 + kPoisson) / (2 * (1 - 2 * kPoisson) * radius * radius * radius));
    return Vector2{strain * shape.r + grown * at.r, strain * shape.z + grown * at.z};
  };
  const int count = extent == Extent::Quick ? 16 : 24;
  MappedBody body{count, count, shell(1, 4), material};
  body.support_r(Side::SLow, no_displacement);
  body.support_z(Side::SHigh, no_displacement);
  body.support(Side::THigh, exact);
  const auto found = body.solve(Strain::Small);
  const Gradient f = body.gradient_at(found.displacement, body.nodes_of(Side::TLow).back());
  const double volume = f[0] + f[3] + f[4] - 3;
  const double stress =
      2 * material.shear() * (f[3] - 1) + (material.bulk() - 2 * material.shear() / 3) * volume;
  to.push_back(close("cavity in a bar under tension (Goodier), nu 0.3",
                     "stress at the equator, of the far one",
                     stress,
                     (27 - 15 * kPoisson) / (2 * (7 - 5 * kPoisson)),
                     5e-3));
}

}  // namespace

Checks elastic_checks(Extent extent) {
  Checks checks;
  add_patch_test(checks);
  add_free_motions(checks);
  add_made_up_field(checks, extent);
  add_thick_cylinder(checks);
  add_thick_sphere(checks, extent);
  add_ball_in_matrix(checks);
  add_pushed_ball(checks);
  add_cavity(checks, extent);
  return checks;
}

}  // namespace palp::fem
