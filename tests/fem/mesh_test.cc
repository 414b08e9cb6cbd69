#include "fem/mesh.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fem/element.h"
#include "fem/mesh_sizes.h"

namespace palp::fem {
namespace {

Specimen with(InclusionShape shape, double depth_mm, double radius_mm) {
  Specimen specimen;
  specimen.inclusion.shape = shape;
  specimen.inclusion.depth = depth_mm * 1e-3;
  specimen.inclusion.radius = radius_mm * 1e-3;
  specimen.inclusion.height = 12e-3;
  return specimen;
}

double volume(const Mesh& mesh, int material) {
  double sum = 0;
  for (const Element& element : mesh.elements) {
    if (element.material != material) continue;
    for (const auto& point : make_geometry(mesh, element).points) sum += point.volume;
  }
  return sum;
}

// make_geometry() aborts on an element turned inside out.
TEST(MeshTest, FillsTheBlockAndTheInclusionForEveryGeometry) {
  for (const auto shape :
       {InclusionShape::Ball, InclusionShape::Cylinder, InclusionShape::Column}) {
    for (const double depth : {0.5, 3.0, 10.0, 27.0, 44.0}) {
      for (const double radius : {0.5, 3.0, 6.0, 16.0, 40.0}) {
        const Specimen specimen = with(shape, depth, radius);
        if (!check(specimen)) continue;
        const Mesh mesh = make_mesh(specimen, Accuracy::Normal);
        const double a = specimen.inclusion.radius;
        const double tall = specimen.inclusion.bottom(specimen.block.height) - depth * 1e-3;
        const double wanted = shape == InclusionShape::Ball ? 4.0 / 3 * std::numbers::pi * a * a * a
                                                            : std::numbers::pi * a * a * tall;
        const double whole = std::numbers::pi * 45e-3 * 45e-3 * 57e-3;
        EXPECT_NEAR(volume(mesh, 1) / wanted, 1, 1e-4) << depth << ' ' << radius;
        EXPECT_NEAR((volume(mesh, 0) + volume(mesh, 1)) / whole, 1, 1e-6);
      }
    }
  }
}

TEST(MeshTest, NodesMoveSmoothlyWithTheDepth) {
  const double step = 1e-6;
  const Mesh low = make_mesh(with(InclusionShape::Ball, 10 - 1, 8), Accuracy::Normal);
  const Mesh mid = make_mesh(with(InclusionShape::Ball, 10 - 1 + step * 1e3, 8), Accuracy::Normal);
  ASSERT_EQ(low.nodes.size(), mid.nodes.size());
  for (std::size_t i = 0; i < low.nodes.size(); ++i) {
    EXPECT_LT(std::hypot(low.nodes[i].r - mid.nodes[i].r, low.nodes[i].z - mid.nodes[i].z),
              3 * step);
  }
}

TEST(MeshTest, FineHasMoreElementsAndCoarseFewer) {
  EXPECT_LT(Sizes{Accuracy::Fine}.contact, Sizes{Accuracy::Normal}.contact);
  EXPECT_GT(Sizes{Accuracy::Fine}.rows, Sizes{Accuracy::Coarse}.rows);
}

TEST(MeshTest, SurfaceRunsFromTheAxisToTheSide) {
  const Mesh mesh = make_mesh(with(InclusionShape::Cylinder, 5, 8), Accuracy::Normal);
  const auto r = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)].r; };
  ASSERT_FALSE(mesh.surface.empty());
  EXPECT_EQ(r(mesh.surface.front()[0]), 0);
  EXPECT_NEAR(r(mesh.surface.back()[2]), 45e-3, 1e-12);
  for (std::size_t i = 1; i < mesh.surface.size(); ++i) {
    EXPECT_EQ(mesh.surface[i][0], mesh.surface[i - 1][2]);
  }
}

TEST(MeshTest, SurfaceNodesLieAsCloseAsAskedOutToTheReach) {
  for (const double depth : {3.0, 10.0, 25.0}) {
    for (const double radius : {3.0, 8.0, 15.0}) {
      const Mesh mesh = make_mesh(with(InclusionShape::Ball, depth, radius),
                                  Accuracy::Coarse,
                                  {.reach = 32e-3, .spacing = 1.5e-3});
      EXPECT_NEAR(
          volume(mesh, 0) + volume(mesh, 1), std::numbers::pi * 45e-3 * 45e-3 * 57e-3, 1e-9);
      double last = 0;
      for (const SurfaceEdge& edge : mesh.surface) {
        for (const int node : edge) {
          const double r = mesh.nodes[static_cast<std::size_t>(node)].r;
          if (last < 32e-3 - 1e-9) {
            EXPECT_LE(r - last, 1.5e-3 + 1e-9) << depth << ' ' << radius;
          }
          last = r;
        }
      }
    }
  }
}

}  // namespace
}  // namespace palp::fem
