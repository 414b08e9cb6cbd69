#pragma once

#include <cstdint>

#include "fem/depth_table.h"
#include "fem/mesh.h"

namespace palp::fem {

/// Solves `count` phantoms drawn between the grid's points and writes into `table` how far the
/// database's interpolation is off there, relative to the force. The table must be whole; `mesh`:
/// that of its members.
[[nodiscard]] Result<void> check_interpolation(DepthTable& table,
                                               std::uint32_t count,
                                               std::uint64_t seed,
                                               Accuracy mesh);

}  // namespace palp::fem
