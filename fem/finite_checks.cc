#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fem/mapped_body.h"
#include "fem/verification.h"

namespace palp::fem {
namespace {

using std::numbers::pi;
constexpr double kSoftModulus = 3;  // [Pa]: a shear modulus of 1 at the incompressible limit
constexpr double kFinitePoisson = 0.49999;

/// Cauchy stress of an incompressible state: the isochoric part; a pressure is free.
struct Stress {
  double rr{};  ///< [Pa]
  double zz{};
  double hoop{};
  double rz{};
};
Stress cauchy(const Gradient& f, double shear) {
  const Gradient p = isochoric(f, shear).stress;
  const double j = volume_ratio(f);
  return {.rr = (p[0] * f[0] + p[1] * f[1]) / j,
          .zz = (p[2] * f[2] + p[3] * f[3]) / j,
          .hoop = p[4] * f[4] / j,
          .rz = (p[0] * f[2] + p[1] * f[3]) / j};
}

void add_homogeneous_states(Checks& to) {
  const double shear = 1;
  const double stretch = 1.6;
  const double thin = 1 / std::sqrt(stretch);
  const Stress pulled = cauchy({thin, 0, 0, stretch, thin}, shear);
  to.push_back(close("neo-Hookean, pulled to 1.6",
                     "stress over shear modulus",
                     pulled.zz - pulled.rr,
                     stretch * stretch - 1 / stretch,
                     1e-12));
  const Stress both = cauchy({stretch, 0, 0, 1 / (stretch * stretch), stretch}, shear);
  to.push_back(close("neo-Hookean, pulled to 1.6 both ways",
                     "stress over shear modulus",
                     both.rr - both.zz,
                     stretch * stretch - std::pow(stretch, -4),
                     1e-12));
  const Stress sheared = cauchy({1, 0, 0.7, 1, 1}, shear);
  to.push_back(close(
      "neo-Hookean, simple shear of 0.7", "stress over shear modulus", sheared.rz, 0.7, 1e-12));
  to.push_back(close("neo-Hookean, simple shear of 0.7",
                     "normal stress difference (Poynting)",
                     sheared.zz - sheared.rr,
                     0.49,
                     1e-12));
}

// A free cylinder pulled to 1.3 on bent elements contracts alike everywhere.
void add_pulled_cylinder(Checks& to) {
  MappedBody body{4,
                  4,
                  [](double s, double t) {
                    const double wave = 0.05 * std::sin(pi * s) * std::sin(pi * t);
                    return Node{s + wave, t + 1.3 * wave};
                  },
                  {kSoftModulus, kFinitePoisson}};
  const auto still = [](const Node& /*place*/) { return Vector2{}; };
  body.support_r(Side::SLow, still);
  body.support_z(Side::TLow, still);
  body.support_z(Side::THigh, [](const Node& /*place*/) { return Vector2{0, 0.3}; });
  const auto found = body.solve(Strain::Finite);
  double force = 0;
  for (const int node : body.nodes_of(Side::THigh)) force += found.reaction[z_of(node)];
  const double shear = body.material().shear();
  to.push_back(close("cylinder pulled to 1.3, finite strain",
                     "force N",
                     found.solved ? force : 0,
                     pi * shear * (1.3 - 1 / (1.3 * 1.3)),
                     1e-4));
}

// The tangent is the derivative of the forces, by central differences.
void add_tangent(Checks& to) {
  const MappedBody body{1,
                        1,
                        [](double s, double t) {
                          return Node{1 + s + 0.2 * t, t - 0.1 * s};
                        },
                        {kSoftModulus, 0.49}};
  const ElementGeometry geometry = make_geometry(body.mesh(), body.mesh().elements[0]);
  ElementVector u{};
  for (std::size_t i = 0; i < 18; ++i) u[i] = 0.05 * std::sin(1.7 * static_cast<double>(i * i + 1));
  const ElementResponse at = respond(geometry, body.material(), Strain::Finite, u);
  double off = 0;
  double largest = 0;
  for (std::size_t j = 0; j < 18; ++j) {
    constexpr double kStep = 1e-6;
    ElementVector up = u;
    ElementVector down = u;
    up[j] += kStep;
    down[j] -= kStep;
    const ElementVector above = internal_forces(geometry, body.material(), up).force;
    const ElementVector below = internal_forces(geometry, body.material(), down).force;
    for (std::size_t i = j; i < 18; ++i) {
      off = std::max(off, std::abs((above[i] - below[i]) / (2 * kStep) - at.tangent[i][j]));
      largest = std::max(largest, std::abs(at.tangent[i][j]));
    }
  }
  to.push_back(
      {"tangent against differences of the forces", "largest error", off / largest, 0, 1e-7});
}

/// p = 2 mu [g(outer) - g(inner)], g = 1/s + 1/(4 s^4), s the hoop stretch: a thick neo-Hookean
/// sphere, incompressible.
double inflation_pressure(double inner_stretch, double outer_over_inner, double shear) {
  const double cube = outer_over_inner * outer_over_inner * outer_over_inner;
  const double outer_stretch =
      std::cbrt((cube + inner_stretch * inner_stretch * inner_stretch - 1) / cube);
  const auto g = [](double s) { return 1 / s + 1 / (4 * s * s * s * s); };
  return 2 * shear * (g(outer_stretch) - g(inner_stretch));
}

void add_inflated_cavity(Checks& to, Extent extent) {
  constexpr double kOuter = 3;
  for (const double stretch : {1.1, 1.3}) {
    const int count = extent == Extent::Quick ? 6 : 12;
    MappedBody body{
        count,
        2 * count,
        [](double s, double t) {
          const double radius = std::pow(kOuter, t);
          const double angle = 0.5 * pi * s;
          return Node{s == 0 ? 0 : radius * std::sin(angle), s == 1 ? 0 : radius * std::cos(angle)};
        },
        {kSoftModulus, kFinitePoisson}};
    const auto still = [](const Node& /*place*/) { return Vector2{}; };
    body.support_r(Side::SLow, still);
    body.support_z(Side::SHigh, still);
    body.support(Side::TLow, [&](const Node& at) {
      return Vector2{(stretch - 1) * at.r, (stretch - 1) * at.z};
    });
    const auto found = body.solve(Strain::Finite);
    double push = 0;  // outward, of half the cavity's wall
    for (const int node : body.nodes_of(Side::TLow)) {
      const Node& at = body.mesh().nodes[static_cast<std::size_t>(node)];
      push += found.reaction[r_of(node)] * at.r + found.reaction[z_of(node)] * at.z;
    }
    const std::string law =
        "cavity inflated to " + std::to_string(stretch).substr(0, 3) + ", finite strain";
    to.push_back(close(law,
                       "pressure Pa",
                       found.solved ? push / (2 * pi * stretch * stretch) : 0,
                       inflation_pressure(stretch, kOuter, body.material().shear()),
                       2e-3));
  }
}

/// Newton's method near its end: the residual's logarithm doubles.
void add_newton_rate(Checks& to) {
  MappedBody body{6, 8, [](double s, double t) { return Node{s, t}; }, {kSoftModulus, 0.4}};
  const auto still = [](const Node& /*place*/) { return Vector2{}; };
  body.support_r(Side::SLow, still);
  body.support(Side::TLow, still);
  body.support_z(Side::THigh, [](const Node& /*place*/) { return Vector2{0, 0.6}; });
  const auto found = body.solve(Strain::Finite);
  // The last three residuals that are above rounding.
  std::vector<double> sound;
  for (const double residual : found.residuals) {
    if (residual > 1e-13 * found.reaction.norm()) sound.push_back(residual);
  }
  const std::size_t n = sound.size();
  const double rate =
      n < 3 ? 0 : std::log(sound[n - 1] / sound[n - 2]) / std::log(sound[n - 2] / sound[n - 3]);
  to.push_back(
      {"Newton's method, bonded cylinder pulled to 1.6", "order of the residual", rate, 2, 0.15});
}

}  // namespace

Checks finite_checks(Extent extent) {
  Checks checks;
  add_homogeneous_states(checks);
  add_pulled_cylinder(checks);
  add_tangent(checks);
  add_inflated_cavity(checks, extent);
  add_newton_rate(checks);
  return checks;
}

}  // namespace palp::fem
