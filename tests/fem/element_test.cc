#include "fem/element.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "fem/assembler.h"
#include "fem/dense_solver.h"

namespace palp::fem {
namespace {

/// One distorted element away from the axis.
Mesh distorted() {
  Mesh mesh;
  for (int k = 0; k < 9; ++k) {
    const double x = k % 3 - 1;
    const double y = k / 3 - 1;
    mesh.nodes.push_back({3 + x + 0.2 * y + 0.1 * x * y, y - 0.15 * x + 0.05 * x * x});
  }
  mesh.elements.push_back({{0, 1, 2, 3, 4, 5, 6, 7, 8}, 0});
  return mesh;
}

ElementVector some_displacement(double size) {
  ElementVector u{};
  for (std::size_t i = 0; i < 18; ++i) u[i] = size * std::sin(1.7 * static_cast<double>(i * i + 1));
  return u;
}

TEST(ElementTest, ForceAndTangentAreDerivativesOfTheEnergy) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  const Material material{2, 0.49};
  const ElementVector u = some_displacement(0.05);
  const ElementResponse at = respond(geometry, material, Strain::Finite, u);
  const ElementForces forces = internal_forces(geometry, material, u);
  const double step = 1e-6;
  for (std::size_t i = 0; i < 18; ++i) {
    ElementVector up = u;
    ElementVector down = u;
    up[i] += step;
    down[i] -= step;
    const double slope =
        (stored_energy(geometry, material, up) - stored_energy(geometry, material, down)) /
        (2 * step);
    EXPECT_NEAR(slope, at.force[i], 1e-6);
    EXPECT_NEAR(forces.force[i], at.force[i], 1e-10);
    const ElementVector above = respond(geometry, material, Strain::Finite, up).force;
    const ElementVector below = respond(geometry, material, Strain::Finite, down).force;
    for (std::size_t j = 0; j < 18; ++j) {
      EXPECT_NEAR((above[j] - below[j]) / (2 * step), at.tangent[j][i], 2e-4);
    }
  }
}

// With the displacements' own pressure the two tangents are one; the force never knows of it.
TEST(ElementTest, APressureOfItsOwnChangesTheTangentAlone) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  const Material material{2, 0.49};
  const ElementVector u = some_displacement(0.05);
  Pressure pressure = pressure_after(geometry, material, u, {});
  const ElementResponse condensed = respond(geometry, material, Strain::Finite, u);
  const ElementResponse same = respond(geometry, material, u, pressure);
  pressure[0] += 1;
  const ElementResponse other = respond(geometry, material, u, pressure);
  double changed = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_EQ(other.force[i], condensed.force[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_NEAR(same.tangent[i][j], condensed.tangent[i][j], 1e-9);
      changed += std::abs(other.tangent[i][j] - condensed.tangent[i][j]);
    }
  }
  EXPECT_GT(changed, 0.1);
}

TEST(ElementTest, ThePressureAfterAStepIsItsFirstOrder) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  const Material material{2, 0.49};
  const ElementVector u = some_displacement(0.05);
  const double size = 1e-5;
  ElementVector step = some_displacement(size);
  std::swap(step[3], step[11]);
  ElementVector end = u;
  for (std::size_t i = 0; i < 18; ++i) end[i] += step[i];
  const Pressure before = pressure_after(geometry, material, u, {});
  const Pressure wanted = pressure_after(geometry, material, end, {});
  const Pressure found = pressure_after(geometry, material, u, step);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found[k], wanted[k], 1e-3 * std::abs(wanted[k] - before[k]) + 1e-9);
  }
}

TEST(ElementTest, OnlyTheLiftAlongTheAxisIsFree) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  const ElementResponse at = respond(geometry, {1, 0.4999}, Strain::Small, {});
  Eigen::MatrixXd stiffness(18, 18);
  for (int i = 0; i < 18; ++i) {
    for (int j = 0; j < 18; ++j) {
      stiffness(i, j) = at.tangent[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  EXPECT_LT((stiffness - stiffness.transpose()).norm(), 1e-12 * stiffness.norm());
  const Eigen::VectorXd values = spectrum_of(stiffness).values;
  EXPECT_LT(std::abs(values[0]), 1e-10 * values[17]);
  EXPECT_GT(values[1], 1e-7 * values[17]);
}

// Both strain measures carry u_r = a r, u_z = b z without error, also nearly incompressible.
TEST(ElementTest, PassesThePatchTest) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  ElementVector u{};
  for (std::size_t k = 0; k < 9; ++k) {
    u[k] = 0.01 * mesh.nodes[k].r;
    u[k + 9] = -0.03 * mesh.nodes[k].z;
  }
  const Material material{1, 0.4999};
  const double lame = material.bulk() - 2 * material.shear() / 3;
  const double energy_density = material.shear() * (2 * 0.01 * 0.01 + 0.03 * 0.03) +
                                0.5 * lame * (0.02 - 0.03) * (0.02 - 0.03);
  double volume = 0;
  for (const auto& point : geometry.points) volume += point.volume;
  const ElementResponse at = respond(geometry, material, Strain::Small, u);
  EXPECT_NEAR(at.energy / (energy_density * volume), 1, 1e-9);
  // No force on the middle node: the stress is in equilibrium.
  EXPECT_NEAR(at.force[4] / at.force[5], 0, 1e-9);
  EXPECT_NEAR(at.force[13] / at.force[16], 0, 1e-9);
}

TEST(ElementTest, AnElementTurnedInsideOutHasInfiniteEnergy) {
  const Mesh mesh = distorted();
  const ElementGeometry geometry = make_geometry(mesh, mesh.elements[0]);
  ElementVector u{};
  for (std::size_t k = 0; k < 9; ++k) u[k + 9] = -2.5 * mesh.nodes[k].z;
  EXPECT_TRUE(std::isinf(stored_energy(geometry, {1, 0.4}, u)));
  EXPECT_LE(internal_forces(geometry, {1, 0.4}, u).volume_ratio_min, 0);
}

}  // namespace
}  // namespace palp::fem
