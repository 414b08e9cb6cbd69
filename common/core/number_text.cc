#include "common/core/number_text.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace palp {

std::string number_text(const char* before, double value, int decimals, const char* after) {
  std::array<char, 64> text{};
  const bool zero = std::abs(value) < 0.5 * std::pow(10, -decimals);
  std::snprintf(text.data(), text.size(), "%s%.*f%s", before, decimals, zero ? 0 : value, after);
  return text.data();
}

}  // namespace palp
