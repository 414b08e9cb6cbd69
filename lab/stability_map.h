#pragma once

#include <string>
#include <vector>

#include "lab/batch.h"
#include "lab/plan.h"

namespace palp::lab {

/// A picture: one square a run, rows of springs, columns of round trips, one panel per grip.
[[nodiscard]] std::string map_svg(const Plan& plan, const std::vector<CaseResult>& results);

}  // namespace palp::lab
