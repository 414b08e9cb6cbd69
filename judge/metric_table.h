#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "judge/metrics.h"

namespace palp::judge {

/// One number of a run as reports name it, in the unit at the end of the name.
struct Metric {
  std::string_view name;
  std::string_view axis;  ///< of a picture: words and unit
  double scale{};         ///< [-], from the value to that unit
  double (*value)(const RunMetrics&);
};

/// All of them, in the order of reports.
[[nodiscard]] std::span<const Metric> metric_table() noexcept;
/// Which of them has that name; nullopt: none.
[[nodiscard]] std::optional<std::size_t> metric_index(std::string_view name) noexcept;

}  // namespace palp::judge
