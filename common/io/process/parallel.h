#pragma once

#include <cstddef>
#include <functional>

namespace palp::io {

/// Processors this process may use, at least 1.
[[nodiscard]] std::size_t processors() noexcept;

/// Calls `work` once with every index below `count`, on `threads` >= 1 threads, the caller's
/// included; returns when all are done. Which thread gets which index is open, so whatever must
/// repeat depends on the index alone. An exception of `work` ends the process. Not for rt.
void for_each_index(std::size_t count,
                    std::size_t threads,
                    const std::function<void(std::size_t)>& work);

}  // namespace palp::io
