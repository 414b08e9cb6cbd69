#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "fem/specimen.h"

namespace palp::fem {

struct Node {
  double r{};  ///< [m]
  double z{};  ///< [m], up; the free surface is 0
};

/// Nine nodes, row by row of the square [-1, 1]^2: 0 1 2 below, 3 4 5 in the middle, 6 7 8 above.
/// At the centre of an inclusion three of them may be one and the same.
struct Element {
  std::array<int, 9> nodes{};
  int material{};  ///< index into the model's materials: 0 block, 1 inclusion
};

/// Three nodes of the free surface, outward: end, middle, end.
using SurfaceEdge = std::array<int, 3>;

/// Quadratic quadrilaterals. A value.
struct Mesh {
  std::vector<Node> nodes;
  std::vector<Element> elements;
  std::vector<SurfaceEdge> surface;  ///< z = 0, from the axis outward
  double half_width{};               ///< [m]
  double height{};                   ///< [m]

  /// Adds the elements of a lattice of (2 columns + 1) x (2 rows + 1) nodes. The orientation of the
  /// lattice may be either; it must be the same throughout.
  void add_block(int columns,
                 int rows,
                 const std::function<int(int column, int row)>& node,
                 int material);
  /// Enters the element sides on z = 0.
  void collect_surface();
};

/// How fine, as a factor on all element sizes.
enum class Accuracy { Coarse, Normal, Fine };

/// How close the nodes of the surface lie even far from the axis, where a map is solved.
struct SurfaceNodes {
  double reach{};    ///< [m], from the axis, below the half width; 0: as the accuracy has it
  double spacing{};  ///< [m], at most, out to there
};

/// Own mapped blocks: a fan of graded rows between the inclusion and a box around it, whose upper
/// side is the surface under the indenter; beyond the box plain rectangles. Smooth in depth,
/// radius and height. `specimen` has passed check(). `surface` is heeded where there is an
/// inclusion; the number of elements then goes by the geometry, in steps.
[[nodiscard]] Mesh make_mesh(const Specimen& specimen,
                             Accuracy accuracy,
                             const SurfaceNodes& surface = {});

}  // namespace palp::fem
