#include "common/core/number_text.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace palp {

std::string number_text(const char* before, double value, int decimals, const char* after) {
  std::array<char, 352> text{};  // the longest double has 309 digits
  const bool zero = std::abs(value) < 0.5 * std::pow(10, -decimals);
  std::snprintf(text.data(), text.size(), "%.*f", decimals, zero ? 0 : value);
  return std::string{before} + text.data() + after;
}

}  // namespace palp
