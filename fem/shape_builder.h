#pragma once

#include <cstddef>
#include <functional>

#include "common/core/result.h"
#include "fem/depth_table.h"
#include "fem/mesh.h"
#include "fem/shape_table.h"

namespace palp::fem {

/// All values of one ball, model L1. Where the tip would come near the block's side the shape goes
/// on as -ln(g) / offset^2 did last; where it would come near a stiff ball it is that of less
/// indentation. A ball that does not fit into the block has the values of the largest that does.
[[nodiscard]] Result<std::vector<float>> solve_shape(const DepthGrid& grid,
                                                     const ShapeTable& axes,
                                                     std::size_t depth,
                                                     std::size_t radius,
                                                     std::size_t ratio,
                                                     Accuracy accuracy);

/// Calls its second argument once with every index below the first, in any order, on any threads.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>&)>;

/// The whole table; a second or two of one core for a ball and ratio.
[[nodiscard]] Result<ShapeTable> solve_shape_table(const DepthGrid& grid,
                                                   ShapeTable axes,
                                                   Accuracy accuracy,
                                                   const ForEach& for_each);

}  // namespace palp::fem
