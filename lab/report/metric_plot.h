#pragma once

#include <string>
#include <vector>

#include "common/plot/figure.h"
#include "lab/plan/batch.h"

namespace palp::lab {

/// A picture of one metric over the first label whose values are numbers, and differ. Cases
/// that differ in other labels are other curves; of cases that differ in their seed alone each is a
/// point and the curve goes through their medians. Too many curves to tell apart: all cases as
/// points. Where no label is a number, over the number of the case. @returns empty: no such metric.
[[nodiscard]] plot::Figure metric_plot(const std::vector<std::string>& label_names,
                                       const std::vector<CaseResult>& results,
                                       const std::string& metric,
                                       const std::string& title);

/// What an axis is called over the values of that label: "rtt_ms" is "round trip [ms]".
[[nodiscard]] std::string axis_words(const std::string& label);

}  // namespace palp::lab
