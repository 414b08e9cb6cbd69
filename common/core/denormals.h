#pragma once

#include <cstdint>

namespace palp {

/// While alive, this thread's floating point takes denormal numbers as 0 and makes none: decaying
/// filters would otherwise slow a tick down by an order of magnitude, and both runners must round
/// alike. Thread: the one that made it; it restores what was before. On machines other than x86-64
/// and AArch64 it changes nothing.
class DenormalFlush {
 public:
  DenormalFlush() noexcept;
  ~DenormalFlush();
  DenormalFlush(const DenormalFlush&) = delete;
  DenormalFlush& operator=(const DenormalFlush&) = delete;

 private:
  std::uint64_t previous_;  ///< control word of the floating-point unit
};

}  // namespace palp
