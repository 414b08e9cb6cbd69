#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "fem/bonded_layer.h"
#include "fem/finite_contact.h"
#include "fem/linear_contact.h"
#include "fem/sneddon_sphere.h"
#include "fem/verification.h"

namespace palp::fem {
namespace {

using std::numbers::pi;
constexpr double kRadius = 5e-3;  // [m], of every indenter here

/// So large that its sides take less than a ten-thousandth of the force.
Specimen half_space(IndenterShape shape, double poisson) {
  Specimen specimen;
  specimen.block.half_width = 1e4 * kRadius;
  specimen.block.height = 1e4 * kRadius;
  specimen.block.poisson = poisson;
  specimen.indenter = {.shape = shape, .radius = kRadius, .slope = 0.3};
  return specimen;
}

double plane_modulus(const Block& block) {
  return block.youngs_modulus / (1 - block.poisson * block.poisson);
}

std::string name_of(const char* what, double poisson, double indentation) {
  char text[96];
  std::snprintf(text, sizeof text, "%s, nu %g, d %g mm", what, poisson, 1e3 * indentation);
  return text;
}

double pressed(const Specimen& specimen, double indentation, Accuracy accuracy) {
  LinearContact contact{make_mesh(specimen, accuracy), specimen, indentation};
  const auto row = contact.press(indentation);
  return row ? row->force : 0;
}

void add_half_spaces(Checks& to, Extent extent) {
  const Accuracy accuracy = Accuracy::Normal;
  for (const double poisson : {0.3, 0.49}) {
    for (const double d : {0.5e-3, 2e-3}) {
      if (extent == Extent::Quick && (poisson < 0.4 || d < 1e-3)) continue;
      const Specimen hertz = half_space(IndenterShape::Paraboloid, poisson);
      const double modulus = plane_modulus(hertz.block);
      to.push_back(close(name_of("paraboloid (Hertz)", poisson, d),
                         "force N",
                         pressed(hertz, d, accuracy),
                         4 * modulus * std::sqrt(kRadius) * d * std::sqrt(d) / 3,
                         3e-3));
      const SneddonSphere sneddon{.radius = kRadius, .modulus = modulus};
      to.push_back(close(name_of("sphere (Sneddon)", poisson, d),
                         "force N",
                         pressed(half_space(IndenterShape::Sphere, poisson), d, accuracy),
                         sneddon.press(d).force,
                         3e-3));
      const Specimen cone = half_space(IndenterShape::Cone, poisson);
      // Its contact must stay on the fine part of the surface.
      const double shallow = 0.5 * d;
      to.push_back(close(name_of("cone (Sneddon)", poisson, shallow),
                         "force N",
                         pressed(cone, shallow, accuracy),
                         2 * modulus * shallow * shallow / (pi * cone.indenter.slope),
                         3e-3));
    }
  }
}

// F = 2 E* a d; beyond the edge the gap to the punch opens with the root of the distance, which is
// what a pressure that is singular with the power -1/2 leaves.
void add_punch(Checks& to, Extent extent) {
  for (const double poisson : {0.3, 0.49, 0.4999}) {
    if (extent == Extent::Quick && poisson > 0.4) continue;
    const Specimen specimen = half_space(IndenterShape::FlatPunch, poisson);
    const Mesh mesh = make_mesh(specimen, Accuracy::Normal);
    constexpr double kDepth = 1e-3;
    LinearContact contact{mesh, specimen, kDepth};
    const auto row = contact.press(kDepth);
    const std::string law = name_of("flat punch (Sneddon)", poisson, kDepth);
    to.push_back(close(law,
                       "force N",
                       row ? row->force : 0,
                       2 * plane_modulus(specimen.block) * kRadius * kDepth,
                       3e-3));
    const Field field = contact.field();
    std::vector<double> x;
    std::vector<double> y;
    for (const SurfaceEdge& edge : mesh.surface) {
      const auto end = static_cast<std::size_t>(edge[2]);
      const double beyond = mesh.nodes[end].r / kRadius - 1;
      if (beyond < 2e-3 || beyond > 3e-2) continue;
      x.push_back(std::log(beyond));
      y.push_back(std::log(kDepth + field[2 * end + 1]));
    }
    const double slope = x.size() < 2 ? 0 : (y.back() - y.front()) / (x.back() - x.front());
    to.push_back({law, "power of the gap at the edge", slope, 0.5, 0.02});
  }
}

void add_bonded_layer(Checks& to, Extent extent) {
  for (const double height : {10e-3, 20e-3}) {
    if (extent == Extent::Quick && height > 10e-3) continue;
    Specimen specimen;
    specimen.block.height = height;
    specimen.block.half_width = 20 * height;  // the layer of the theory has no side
    const Block& block = specimen.block;
    const BondedLayer layer{height, block.youngs_modulus, block.poisson, specimen.indenter.radius};
    for (const double d : {0.5e-3, 1e-3, 2e-3}) {
      char law[64];
      std::snprintf(
          law, sizeof law, "bonded layer of %g mm (Hayes), d %g mm", 1e3 * height, 1e3 * d);
      to.push_back(
          close(law, "force N", pressed(specimen, d, Accuracy::Normal), layer.force(d), 3e-3));
    }
  }
}

Specimen with_ball() {
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 6e-3, .radius = 8e-3, .ratio = 50};
  return specimen;
}

// F = dW/dd: what the tip does is stored. Both models.
template <typename Contact>
void add_energy(Checks& to, Contact& contact, const char* law, double indentation) {
  const double step = 1e-6;
  std::vector<double> energies;
  double force = 0;
  for (const double d : {indentation - step, indentation, indentation + step}) {
    const auto row = contact.press(d);
    energies.push_back(contact.energy());
    if (d == indentation && row) force = row->force;
  }
  to.push_back(close(law, "force N", force, (energies[2] - energies[0]) / (2 * step), 1e-3));
}

void add_both_models(Checks& to, Extent extent) {
  const Accuracy accuracy = extent == Extent::Quick ? Accuracy::Coarse : Accuracy::Normal;
  const Specimen specimen = with_ball();
  const Mesh mesh = make_mesh(specimen, accuracy);
  LinearContact linear{mesh, specimen, 2.1e-3};
  to.push_back({"ball of 8 mm at 6 mm, small strain",
                "asymmetry of the surface's compliance",
                linear.asymmetry(),
                0,
                1e-10});
  add_energy(to, linear, "force is the slope of the energy, l1, d 2 mm", 2e-3);
  FiniteContact finite{mesh, specimen};
  add_energy(to, finite, "force is the slope of the energy, neo, d 2 mm", 2e-3);
  FiniteContact shallow{mesh, specimen};
  constexpr double kShallow = 0.02e-3;
  const auto row = shallow.press(kShallow);
  const auto wanted = linear.press(kShallow);
  to.push_back(close("neo becomes l1 at small indentation, d 0.02 mm",
                     "force N",
                     row ? row->force : 0,
                     wanted ? wanted->force : 1,
                     1e-2));
}

}  // namespace

Checks contact_checks(Extent extent) {
  Checks checks;
  add_half_spaces(checks, extent);
  add_punch(checks, extent);
  add_bonded_layer(checks, extent);
  add_both_models(checks, extent);
  return checks;
}

}  // namespace palp::fem
