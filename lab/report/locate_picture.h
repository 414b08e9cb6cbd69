#pragma once

#include <vector>

#include "common/plot/figure.h"
#include "lab/plan/locate_study.h"

namespace palp::lab {

/// Of the balls found: lateral error and depth over the true depth, with their intervals.
[[nodiscard]] plot::Figure locate_figure(const std::vector<LocateCase>& cases);

}  // namespace palp::lab
