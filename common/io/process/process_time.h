#pragma once

#include "common/core/time.h"

namespace palp::io {

/// What this process has used so far: for accounts of what a computation cost.
struct ProcessTime {
  Duration cpu{};   ///< all threads together
  Duration wall{};  ///< since an arbitrary instant
};

[[nodiscard]] ProcessTime process_time() noexcept;

}  // namespace palp::io
