#include "fem/harmonic_body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fem/linear_contact.h"

namespace palp::fem {
namespace {

Specimen ball_of(double radius, double depth, double ratio) {
  Specimen specimen;
  specimen.inclusion = {
      .shape = InclusionShape::Ball, .depth = depth, .radius = radius, .ratio = ratio};
  return specimen;
}

/// The first nodes of the surface, as LinearContact collects them.
std::vector<int> surface_nodes(const Mesh& mesh, std::size_t count) {
  std::vector<int> nodes;
  for (const SurfaceEdge& edge : mesh.surface) {
    for (std::size_t k = nodes.empty() ? 0 : 1; k < 3; ++k) nodes.push_back(edge[k]);
  }
  nodes.resize(std::min(count, nodes.size()));
  return nodes;
}

TEST(HarmonicBodyTest, OrderZeroIsTheComplianceOfTheAxisymmetricContact) {
  const Specimen specimen = ball_of(8e-3, 6e-3, 856);
  const Mesh mesh = make_mesh(specimen, Accuracy::Coarse);
  const LinearContact contact{mesh, specimen, 2e-3};
  const Eigen::MatrixXd& wanted = contact.compliance();
  HarmonicBody body{mesh, surface_nodes(mesh, static_cast<std::size_t>(wanted.rows()))};
  const Eigen::MatrixXd found = body.compliance(materials_of(specimen), 0);
  EXPECT_LT((found - wanted).norm(), 1e-9 * wanted.norm());
}

TEST(HarmonicBodyTest, ComplianceIsSymmetricPositiveAndNothingHigherMovesTheAxis) {
  const Specimen specimen = ball_of(5e-3, 5e-3, 100);
  const Mesh mesh = make_mesh(specimen, Accuracy::Coarse);
  HarmonicBody body{mesh, surface_nodes(mesh, 20)};
  for (const int order : {1, 2, 5}) {
    const Eigen::MatrixXd found = body.compliance(materials_of(specimen), order);
    EXPECT_LT((found - found.transpose()).norm(), 1e-9 * found.norm()) << order;
    EXPECT_EQ(found.row(0).norm(), 0) << order;
    for (Eigen::Index i = 1; i < found.rows(); ++i) EXPECT_GT(found(i, i), 0) << order;
  }
}

// Boussinesq: a point force P sinks the surface of a half space by (1 - nu^2) P / (pi E rho) at the
// distance rho. Harmonics of a force at r' fall as (r / r')^n, so nine of them are enough.
TEST(HarmonicBodyTest, AllHarmonicsTogetherSinkAsBoussinesqSays) {
  Specimen specimen = ball_of(5e-3, 20e-3, 1);
  specimen.block = {.half_width = 20, .height = 20, .youngs_modulus = 15.3e3, .poisson = 0.49};
  const Mesh mesh = make_mesh(specimen, Accuracy::Normal, {.reach = 16e-3, .spacing = 1.5e-3});
  const std::vector<int> nodes = surface_nodes(mesh, 1000);
  const auto r = [&](std::size_t i) { return mesh.nodes[static_cast<std::size_t>(nodes[i])].r; };
  std::size_t near = 0;
  while (r(near) < 5e-3) ++near;
  std::size_t far = near;
  while (r(far) < 15e-3) ++far;
  HarmonicBody body{mesh, {nodes[near], nodes[far]}};
  std::vector<double> terms;
  for (int order = 0; order <= 8; ++order) {
    terms.push_back(body.compliance(materials_of(specimen), order)(0, 1));
  }
  for (const double phi : {0.0, 0.8, 2.0, std::numbers::pi}) {
    double sinking = 0;
    for (std::size_t n = 0; n < terms.size(); ++n) {
      sinking += terms[n] * std::cos(static_cast<double>(n) * phi);
    }
    const double rho =
        std::sqrt(r(near) * r(near) + r(far) * r(far) - 2 * r(near) * r(far) * std::cos(phi));
    const double wanted = (1 - 0.49 * 0.49) / (std::numbers::pi * 15.3e3 * rho);
    EXPECT_NEAR(sinking / wanted, 1, 0.01) << phi;
  }
}

}  // namespace
}  // namespace palp::fem
