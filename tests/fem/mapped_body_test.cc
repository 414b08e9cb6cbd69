#include "fem/mapped_body.h"

#include <numbers>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

MappedBody cylinder() {
  return {3, 2, [](double s, double t) { return Node{s, 2 * t}; }, {2, 0.25}};
}

TEST(MappedBodyTest, SidesAreWhereTheSquareHasThem) {
  const MappedBody body = cylinder();
  for (const int node : body.nodes_of(Side::SHigh)) {
    EXPECT_EQ(body.mesh().nodes[static_cast<std::size_t>(node)].r, 1);
  }
  for (const int node : body.nodes_of(Side::THigh)) {
    EXPECT_EQ(body.mesh().nodes[static_cast<std::size_t>(node)].z, 2);
  }
  EXPECT_EQ(body.nodes_of(Side::SLow).size(), 5U);
  EXPECT_EQ(body.nodes_of(Side::TLow).size(), 7U);
}

// A cylinder under traction t lengthens by t / E; its support gives the whole load back.
TEST(MappedBodyTest, ATractionIsCarriedToTheSupport) {
  MappedBody body = cylinder();
  const auto still = [](const Node& /*place*/) { return Vector2{}; };
  body.support_r(Side::SLow, still);
  body.support_z(Side::TLow, still);
  body.pull(Side::THigh, [](const Node& /*place*/) { return Vector2{0, 0.02}; });
  const auto found = body.solve(Strain::Small);
  EXPECT_TRUE(found.solved);
  EXPECT_NEAR(found.displacement[z_of(body.nodes_of(Side::THigh)[2])], 0.02, 1e-12);
  EXPECT_NEAR(found.displacement[r_of(body.nodes_of(Side::SHigh)[2])], -0.0025, 1e-12);
  double force = 0;
  for (const int node : body.nodes_of(Side::TLow)) force += found.reaction[z_of(node)];
  EXPECT_NEAR(force, -0.02 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(body.gradient_at(found.displacement, body.nodes_of(Side::THigh)[0])[3], 1.01, 1e-10);
}

TEST(MappedBodyTest, ABodyForceIsCarriedToTheSupport) {
  MappedBody body = cylinder();
  const auto still = [](const Node& /*place*/) { return Vector2{}; };
  body.support_r(Side::SLow, still);
  body.support_z(Side::TLow, still);
  body.fill([](const Node& /*place*/) { return Vector2{0, -0.5}; });
  const auto found = body.solve(Strain::Small);
  double force = 0;
  for (const int node : body.nodes_of(Side::TLow)) force += found.reaction[z_of(node)];
  EXPECT_NEAR(force, 0.5 * 2 * std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace palp::fem
