#include "common/core/check.h"

#include <cstdio>
#include <cstdlib>

namespace palp {

void check_failed(const char* condition, const char* message, const char* file, int line) noexcept {
  std::fprintf(stderr, "%s:%d: check failed: %s (%s)\n", file, line, message, condition);
  std::abort();
}

}  // namespace palp
