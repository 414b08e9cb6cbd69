#pragma once

#include <utility>
#include <vector>

#include "judge/metric_table.h"
#include "lab/plan/batch.h"
#include "lab/plan/plan.h"

namespace palp::lab {

/// As many cases as the plan has, and nothing was felt in them.
inline std::vector<CaseResult> empty_cases(const Plan& plan) {
  std::vector<CaseResult> results;
  for (const Case& one : plan.cases) {
    CaseResult result;
    result.index = one.index;
    result.seed = one.seed;
    result.labels = one.labels;
    result.values.assign(judge::metric_table().size(), judge::kUndefined);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace palp::lab
