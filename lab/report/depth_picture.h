#pragma once

#include <vector>

#include "common/plot/figure.h"
#include "lab/plan/depth_study.h"

namespace palp::lab {

/// Estimates and their intervals over the truth; of random phantoms also the share of the intervals
/// that hold it, with the error of counting so many.
[[nodiscard]] plot::Figure depth_figure(const DepthStudy& study,
                                        const std::vector<DepthCase>& cases);

}  // namespace palp::lab
