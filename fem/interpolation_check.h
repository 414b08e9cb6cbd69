#pragma once

#include <cstdint>

#include "fem/depth_table.h"

namespace palp::fem {

/// Solves `count` phantoms drawn between the grid's points and writes into `table` how far the
/// database's interpolation is off there, relative to the force. The table must be whole.
[[nodiscard]] Result<void> check_interpolation(DepthTable& table,
                                               std::uint32_t count,
                                               std::uint64_t seed);

}  // namespace palp::fem
