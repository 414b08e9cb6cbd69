#pragma once

#include <string>

namespace palp {

/// "force 0.48 N": `before`, the value with so many decimals and never as "-0.00", `after`.
[[nodiscard]] std::string number_text(const char* before,
                                      double value,
                                      int decimals,
                                      const char* after);

}  // namespace palp
