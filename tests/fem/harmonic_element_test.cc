#include "fem/harmonic_element.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace palp::fem {
namespace {

constexpr Material kSoft{15.3e3, 0.49};

/// Amplitudes of a displacement along r, z and phi at a node.
using Field3 = std::function<std::array<double, 3>(const Node&)>;

/// Two by two distorted elements away from the axis.
Mesh distorted_ring() {
  Mesh mesh;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      const double wave = 0.3e-3 * std::sin(2.0 * row + 1.3 * column);
      mesh.nodes.push_back({3e-3 + column * 1e-3 + wave, -5e-3 + row * 1.2e-3 - 0.5 * wave});
    }
  }
  mesh.add_block(
      2, 2, [](int column, int row) { return 5 * row + column; }, 0);
  return mesh;
}

std::array<double, 27> sampled(const Mesh& mesh, const Element& element, const Field3& field) {
  std::array<double, 27> out{};
  for (std::size_t k = 0; k < 9; ++k) {
    const auto at = field(mesh.nodes[static_cast<std::size_t>(element.nodes[k])]);
    for (std::size_t component = 0; component < 3; ++component)
      out[9 * component + k] = at[component];
  }
  return out;
}

double entry(const HarmonicMatrix& matrix, std::size_t i, std::size_t j) {
  return i >= j ? matrix[i][j] : matrix[j][i];
}

/// What a field costs and where it is not in balance.
struct Answer {
  double energy{};                            ///< [J]
  double volume{};                            ///< [m^3]
  std::vector<std::array<double, 3>> forces;  ///< [N], of each node
};

Answer answer_of(const Mesh& mesh, int order, const Field3& field) {
  Answer answer;
  answer.forces.resize(mesh.nodes.size());
  for (const Element& element : mesh.elements) {
    const ElementGeometry geometry = make_geometry(mesh, element);
    const HarmonicMatrix stiffness = harmonic_stiffness(geometry, kSoft, order);
    const auto u = sampled(mesh, element, field);
    for (const auto& point : geometry.points) answer.volume += point.volume;
    for (std::size_t i = 0; i < 27; ++i) {
      double force = 0;
      for (std::size_t j = 0; j < 27; ++j) force += entry(stiffness, i, j) * u[j];
      answer.energy += 0.5 * force * u[i];
      answer.forces[static_cast<std::size_t>(element.nodes[i % 9])][i / 9] += force;
    }
  }
  return answer;
}

TEST(HarmonicElementTest, OrderZeroIsTheAxisymmetricElement) {
  const Mesh mesh = distorted_ring();
  for (const Element& element : mesh.elements) {
    const ElementGeometry geometry = make_geometry(mesh, element);
    const HarmonicMatrix stiffness = harmonic_stiffness(geometry, kSoft, 0);
    const ElementResponse axial = respond(geometry, kSoft, Strain::Small, ElementVector{});
    for (std::size_t i = 0; i < 18; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        EXPECT_NEAR(stiffness[i][j], axial.tangent[i][j], 1e-9 * axial.tangent[i][i]);
      }
    }
  }
}

// A sideways shift and a turn about a sideways axis; both are of order 1.
TEST(HarmonicElementTest, MotionsOfARigidBodyCostNoEnergy) {
  const Mesh mesh = distorted_ring();
  const Answer shift = answer_of(mesh, 1, [](const Node&) {
    return std::array<double, 3>{1e-3, 0, -1e-3};
  });
  const Answer turn = answer_of(mesh, 1, [](const Node& node) {
    return std::array<double, 3>{0.2 * node.z, -0.2 * node.r, -0.2 * node.z};
  });
  const Answer stretch = answer_of(mesh, 1, [](const Node&) {
    return std::array<double, 3>{1e-3, 0, 1e-3};
  });
  EXPECT_LT(std::abs(shift.energy), 1e-12 * stretch.energy);
  EXPECT_LT(std::abs(turn.energy), 1e-12 * stretch.energy);
}

// u_z = g x and, at order 2, u_x = s x, u_y = -s y: even stress, so no forces inside, and an energy
// of the volume's alone, on a distorted mesh.
TEST(HarmonicElementTest, PassesThePatchTestInOrdersOneAndTwo) {
  const Mesh mesh = distorted_ring();
  const double g = 1e-3;
  const Answer shear = answer_of(mesh, 1, [&](const Node& node) {
    return std::array<double, 3>{0, g * node.r, 0};
  });
  EXPECT_NEAR(shear.energy / (0.5 * kSoft.shear() * g * g * shear.volume), 1, 1e-12);
  const Answer squeeze = answer_of(mesh, 2, [&](const Node& node) {
    return std::array<double, 3>{g * node.r, 0, -g * node.r};
  });
  EXPECT_NEAR(squeeze.energy / (2 * kSoft.shear() * g * g * squeeze.volume), 1, 1e-12);
  const double scale = kSoft.shear() * g * 1e-4;  // [N], on a side of the ring
  for (const std::size_t inner : {6U, 7U, 8U, 11U, 12U, 13U, 16U, 17U, 18U}) {
    for (std::size_t component = 0; component < 3; ++component) {
      EXPECT_LT(std::abs(shear.forces[inner][component]), 1e-10 * scale);
      EXPECT_LT(std::abs(squeeze.forces[inner][component]), 1e-10 * scale);
    }
  }
}

// u_x = s x of order 0 and 2 changes the volume; only the bulk modulus stiffens it.
TEST(HarmonicElementTest, AChangeOfVolumeFeelsTheBulkModulus) {
  const Mesh mesh = distorted_ring();
  const double s = 1e-3;
  const Answer wide = answer_of(mesh, 0, [&](const Node& node) {
    return std::array<double, 3>{s * node.r, s * node.z, 0};
  });
  EXPECT_NEAR(wide.energy / (4.5 * kSoft.bulk() * s * s * wide.volume), 1, 1e-10);
}

}  // namespace
}  // namespace palp::fem
