#include "fem/mesh.h"

#include <algorithm>

namespace palp::fem {
namespace {

using Lattice = std::array<int, 9>;

/// Twice the signed area spanned by the middle lines.
double orientation(const std::vector<Node>& nodes, const Lattice& n) {
  const auto at = [&](std::size_t i) { return nodes[static_cast<std::size_t>(n[i])]; };
  return (at(5).r - at(3).r) * (at(7).z - at(1).z) - (at(5).z - at(3).z) * (at(7).r - at(1).r);
}

}  // namespace

void Mesh::add_block(int columns,
                     int rows,
                     const std::function<int(int column, int row)>& node,
                     int material) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Element element;
      element.material = material;
      for (int k = 0; k < 9; ++k) {
        element.nodes[static_cast<std::size_t>(k)] = node(2 * column + k % 3, 2 * row + k / 3);
      }
      if (orientation(nodes, element.nodes) < 0) {
        for (std::size_t k : {0U, 3U, 6U}) std::swap(element.nodes[k], element.nodes[k + 2]);
      }
      elements.push_back(element);
    }
  }
}

void Mesh::collect_surface() {
  const auto at = [&](int node) { return nodes[static_cast<std::size_t>(node)]; };
  for (const Element& element : elements) {
    constexpr std::array<std::array<std::size_t, 3>, 4> kSides{
        {{0, 1, 2}, {2, 5, 8}, {8, 7, 6}, {6, 3, 0}}};
    for (const auto& side : kSides) {
      SurfaceEdge edge{};
      for (std::size_t i = 0; i < 3; ++i) edge[i] = element.nodes[side[i]];
      const bool free =
          std::all_of(edge.begin(), edge.end(), [&](int node) { return at(node).z == 0; });
      if (!free) continue;
      if (at(edge[0]).r > at(edge[2]).r) std::swap(edge[0], edge[2]);
      surface.push_back(edge);
    }
  }
  std::sort(surface.begin(), surface.end(), [&](const SurfaceEdge& a, const SurfaceEdge& b) {
    return at(a[0]).r < at(b[0]).r;
  });
}

}  // namespace palp::fem
