#pragma once

namespace palp::io {

/// A descriptor that becomes readable at SIGINT or SIGTERM, for programs that wait in the kernel.
/// Once, before other threads. Negative: none could be made.
[[nodiscard]] int open_stop_signals() noexcept;

}  // namespace palp::io
