#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "fem/curve.h"
#include "fem/depth_table.h"

namespace palp::fem {

/// One place of a mesh: all stiffness ratios of a geometry are solved on the same mesh, and so is
/// the plain block (ratio 1), so that the mesh's own error leaves the excess.
struct GridCell {
  InclusionShape shape{};
  std::uint32_t depth{};
  std::uint32_t radius{};
};

/// Every cell of the grid whose inclusion fits into the block.
[[nodiscard]] std::vector<GridCell> cells_of(const DepthGrid& grid);

/// [m], how far a curve goes above an inclusion at `depth`: the cover under a stiff inclusion is
/// squeezed to a fifth at most.
[[nodiscard]] double indentation_limit(const DepthGrid& grid, double depth);

/// Members of one cell, one per ratio. Model N.
[[nodiscard]] std::vector<DepthMember> solve_cell(const DepthGrid& grid,
                                                  const GridCell& cell,
                                                  Accuracy accuracy = Accuracy::Coarse);

/// Force of the plain block at the grid's indentations, on a fine mesh. [N]
[[nodiscard]] Result<std::vector<double>> solve_plain(const DepthGrid& grid);

/// What the grid's block is with such an inclusion in it.
[[nodiscard]] Specimen specimen_of(
    const DepthGrid& grid, InclusionShape shape, double depth, double radius, double ratio);

}  // namespace palp::fem
