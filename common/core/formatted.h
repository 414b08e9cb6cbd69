#pragma once

#include <string>

namespace palp {

/// As printf writes it, however long it gets. Thread: any; allocates.
[[nodiscard, gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace palp
