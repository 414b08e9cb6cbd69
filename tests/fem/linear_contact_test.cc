#include "fem/linear_contact.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

TEST(LinearContactTest, ComplianceIsSymmetricAndForceIsTheSlopeOfTheEnergy) {
  Specimen specimen;
  specimen.inclusion = {.shape = InclusionShape::Ball, .depth = 6e-3, .radius = 8e-3};
  LinearContact contact{make_mesh(specimen, Accuracy::Coarse), specimen, 3e-3};
  EXPECT_LT(contact.asymmetry(), 1e-10);
  const double step = 1e-6;
  ASSERT_TRUE(contact.press(2e-3 + step));
  const double above = contact.energy();
  ASSERT_TRUE(contact.press(2e-3 - step));
  const double below = contact.energy();
  const auto at = contact.press(2e-3);
  ASSERT_TRUE(at);
  EXPECT_NEAR((above - below) / (2 * step) / at->force, 1, 1e-4);
}

TEST(LinearContactTest, NothingIsPulledAndNothingOverlaps) {
  Specimen specimen;
  const Mesh mesh = make_mesh(specimen, Accuracy::Coarse);
  LinearContact contact{mesh, specimen, 2e-3};
  const auto row = contact.press(2e-3);
  ASSERT_TRUE(row);
  const Field field = contact.field();
  for (const SurfaceEdge& edge : mesh.surface) {
    for (const int node : edge) {
      const double r = mesh.nodes[static_cast<std::size_t>(node)].r;
      const double sunk = -field[static_cast<std::size_t>(2 * node + 1)];
      EXPECT_GE(sunk, 2e-3 - specimen.indenter.profile(r) - 1e-9);
    }
  }
  EXPECT_GT(row->contact_radius, 2e-3);
  EXPECT_LT(row->contact_radius, 5e-3);
}

// Sneddon: F = 2 E* a d under a rigid flat punch on a half-space.
TEST(LinearContactTest, FlatPunchFollowsSneddon) {
  Specimen specimen;
  specimen.block = {.half_width = 5, .height = 5, .youngs_modulus = 15.3e3, .poisson = 0.3};
  specimen.indenter = {.shape = IndenterShape::FlatPunch, .radius = 5e-3};
  LinearContact contact{make_mesh(specimen, Accuracy::Normal), specimen, 1e-3};
  const auto row = contact.press(1e-3);
  ASSERT_TRUE(row);
  const double wanted = 2 * 15.3e3 / (1 - 0.09) * 5e-3 * 1e-3;
  EXPECT_NEAR(row->force / wanted, 1, 5e-3);
}

}  // namespace
}  // namespace palp::fem
