#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fem/depth_table.h"
#include "fem/mesh.h"
#include "fem/shape_table.h"

namespace palp::fem {

/// How finely a database is solved. Coarse: fewer phantoms, about 1 % of the force off between
/// them. Normal: as the database in the program. Fine: the same phantoms on finer meshes.
enum class Detail { Coarse, Normal, Fine };

/// The mesh of the members; that of the shape beside the axis is the next finer one.
[[nodiscard]] Accuracy member_mesh(Detail detail) noexcept;
[[nodiscard]] Accuracy shape_mesh(Detail detail) noexcept;

/// The grid of default_grid() as far as it fits into the block: radii that fit at two depths or
/// more, indentations to the tip's radius or 5 mm. Of the paper's block and tip, Normal, it is
/// default_grid().
[[nodiscard]] DepthGrid grid_for(const Block& block,
                                 double indenter_radius,
                                 double inclusion_poisson,
                                 Detail detail);

/// `grid` with the axes that a text gives: lines `depth_mm`, `radius_mm`, `ratio` or
/// `indentation_mm`, each with rising numbers; # begins a comment. The sentence names the line.
[[nodiscard]] Result<DepthGrid> with_axes(DepthGrid grid, std::string_view text);

/// Whether a database over this grid can be solved and read: the block and tip are sound, every
/// radius fits at two depths whose cover takes the whole indentation.
[[nodiscard]] Result<void> check(const DepthGrid& grid);

/// Axes of the shape beside the axis over those of the grid; no values.
[[nodiscard]] ShapeTable shape_axes(const DepthGrid& grid, Detail detail);

/// What a database takes, before it is solved.
struct Forecast {
  std::size_t curves{};  ///< on the axis
  std::size_t balls{};   ///< beside it
  double work{};         ///< [s], of one processor as fast as the one it was measured on
  double bytes{};        ///< [bytes], of the file
  double error_share{};  ///< [-], of F, between the grid's points at worst
};
/// From how the default grid's times and error scale; true within a factor of about two.
[[nodiscard]] Forecast forecast(const DepthGrid& grid, Detail detail, bool off_axis);
/// One line for a person who waits.
[[nodiscard]] std::string forecast_text(const Forecast& forecast, std::size_t cores);

}  // namespace palp::fem
