#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.h"
#include "fem/shape_table.h"
#include "fem/specimen.h"

namespace palp::fem {

/// The grid of a depth database and the block it was solved for. A cylinder stands as high as it is
/// wide, so that both shapes have one radius.
struct DepthGrid {
  Block block;
  double indenter_radius{5e-3};      ///< [m]
  double inclusion_poisson{0.49};    ///< [-]
  std::vector<double> depths;        ///< [m], of the inclusion's top, rising
  std::vector<double> radii;         ///< [m], rising
  std::vector<double> ratios;        ///< [-], rising, above 1
  std::vector<double> indentations;  ///< [m], rising, above 0
  friend bool operator==(const DepthGrid&, const DepthGrid&);
};
inline constexpr double kCylinderHeightOverRadius = 2;

/// Depth 3 to 27 mm, radius 3 to 16 mm, ratio 3 to 900, indentation to 5 mm; the paper's block.
[[nodiscard]] DepthGrid default_grid();

/// The force over that of the plain block, minus one.
struct DepthMember {
  InclusionShape shape{};
  std::uint32_t depth{};  ///< indices into the grid
  std::uint32_t radius{};
  std::uint32_t ratio{};
  std::vector<float> excess;  ///< [-], at the grid's indentations; shorter: not solved beyond
};

/// A database as it is stored: what was solved, nothing interpolated.
struct DepthTable {
  DepthGrid grid;
  std::string model{"neo"};
  std::string made_by;
  std::vector<double> plain;  ///< [N], without inclusion, at the grid's indentations
  std::vector<DepthMember> members;
  double checked_rms{};           ///< [-], of F: interpolated against solved between grid points
  double checked_max{};           ///< [-]
  std::uint32_t checked_count{};  ///< 0: not checked
  std::optional<ShapeTable> off_axis;
};

[[nodiscard]] std::string table_bytes(const DepthTable& table);
/// What is not exactly a table of this version is refused in one sentence.
[[nodiscard]] Result<DepthTable> parse_table(std::string_view bytes);

/// Members of both, and the shape beside the axis of the one that has it; the grids must be the
/// same.
[[nodiscard]] Result<void> merge_table(DepthTable& into, const DepthTable& from);

}  // namespace palp::fem
