#pragma once

#include "common/core/result.h"
#include "fem/depth_table.h"
#include "fem/mesh.h"
#include "fem/shape_table.h"

namespace palp::fem {

/// The axes of the shape table over those of the depth database: depth 3 to 27 mm, radius 3 to
/// 16 mm, ratio 3 to 900, offset to 3, indentation to 5 mm; no values.
[[nodiscard]] ShapeTable shape_axes();

/// All values of one ball, model L1. Where the tip would come near the block's side the shape goes
/// on as -ln(g) / offset^2 did last; where it would come near a stiff ball it is that of less
/// indentation. A ball that does not fit into the block has the values of the largest that does.
[[nodiscard]] Result<std::vector<float>> solve_shape(const DepthGrid& grid,
                                                     const ShapeTable& axes,
                                                     std::size_t depth,
                                                     std::size_t radius,
                                                     std::size_t ratio,
                                                     Accuracy accuracy);

/// The whole table. Minutes.
[[nodiscard]] Result<ShapeTable> solve_shape_table(const DepthGrid& grid,
                                                   ShapeTable axes,
                                                   Accuracy accuracy);

}  // namespace palp::fem
