#pragma once

#include <cstdint>

namespace palp::io {

/// 64 bits that nobody can guess: ids and challenges. @throws std::runtime_error where the kernel
/// has none. Thread: any but rt.
[[nodiscard]] std::uint64_t draw_entropy();

}  // namespace palp::io
