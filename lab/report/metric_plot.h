#pragma once

#include <string>
#include <vector>

#include "lab/plan/batch.h"

namespace palp::lab {

/// A picture (SVG) of one metric over the first label whose values are numbers, and differ. Cases
/// that differ in other labels are other curves; of cases that differ in their seed alone each is a
/// point and the curve goes through their medians. Too many curves to tell apart: all cases as
/// points. Where no label is a number, over the number of the case. @returns empty: no such metric.
[[nodiscard]] std::string metric_plot(const std::vector<std::string>& label_names,
                                      const std::vector<CaseResult>& results,
                                      const std::string& metric,
                                      const std::string& title);

}  // namespace palp::lab
