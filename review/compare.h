#pragma once

#include <string>
#include <vector>

#include "judge/metrics.h"

namespace palp::review {

/// One of the sessions that are compared.
struct Compared {
  std::string name;      ///< for people, short
  std::string coupling;  ///< empty: unknown
  judge::RunMetrics metrics;
};

/// For people: all metrics, a line each, the sessions side by side.
[[nodiscard]] std::string comparison_text(const std::vector<Compared>& sessions);

}  // namespace palp::review
