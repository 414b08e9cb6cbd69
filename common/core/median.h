#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace palp {

/// Middle value, of an even number the mean of both; nullopt: none.
[[nodiscard]] inline std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t upper = values.size() / 2;
  return values.size() % 2 == 1 ? values[upper] : 0.5 * (values[upper - 1] + values[upper]);
}

}  // namespace palp
