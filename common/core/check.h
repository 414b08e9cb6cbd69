#pragma once

/// PALP_CHECK(condition, "what must hold"): a broken invariant is our bug. Prints one line to
/// standard error and aborts, in every build. Never reachable from the wire or from a file.
#define PALP_CHECK(condition, message)                               \
  do {                                                               \
    if (!(condition)) {                                              \
      ::palp::check_failed(#condition, message, __FILE__, __LINE__); \
    }                                                                \
  } while (false)

namespace palp {

[[noreturn]] void check_failed(const char* condition,
                               const char* message,
                               const char* file,
                               int line) noexcept;

}  // namespace palp
