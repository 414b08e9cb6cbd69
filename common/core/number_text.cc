#include "common/core/number_text.h"

#include <cmath>

#include "common/core/formatted.h"

namespace palp {

std::string number_text(const char* before, double value, int decimals, const char* after) {
  const bool zero = std::abs(value) < 0.5 * std::pow(10, -decimals);
  return formatted("%s%.*f%s", before, decimals, zero ? 0 : value, after);
}

}  // namespace palp
