#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/core/result.h"
#include "judge/metrics.h"
#include "lab/plan/plan.h"

/// Runs the cases of a plan, each by itself, and sums them up. What comes out depends on the plan
/// alone: not on the number of threads, nor on how it was cut into shards.
namespace palp::lab {

struct CaseResult {
  std::uint64_t index{};
  std::uint64_t seed{};
  std::vector<std::string> labels;
  std::string made_by;  ///< empty: as the plan
  std::uint64_t digest{};
  double virtual_span{};  ///< [s]
  std::string outcome;
  bool unstable{};
  std::string unstable_reason;
  std::vector<double>
      values;  ///< [as the metric], as judge::metric_table(), nine digits, NaN: undefined
};

/// Calls the function once per index, in any order, on any threads.
using ForEach = std::function<void(std::size_t count, const std::function<void(std::size_t)>&)>;
/// How many of how many are done; called from any thread, one at a time.
using Progress = std::function<void(std::size_t done, std::size_t count)>;

/// A case is done; called as Progress is, before it.
using CaseSink = std::function<void(const CaseResult& result)>;

/// Sorted by index. A case that cannot be made is an error of the plan.
[[nodiscard]] Result<std::vector<CaseResult>> run_plan(const Plan& plan,
                                                       const ForEach& for_each,
                                                       const Progress& progress,
                                                       const CaseSink& sink = {});

/// Of the absolute values: element min(n - 1, floor(p n)) of n sorted ones, undefined ones last.
struct Spread {
  double p50{judge::kUndefined};  ///< [as the metric]
  double p90{judge::kUndefined};  ///< [as the metric]
  double p95{judge::kUndefined};  ///< [as the metric]
  double p99{judge::kUndefined};  ///< [as the metric]
  double max{judge::kUndefined};  ///< [as the metric], of the defined ones
  std::uint64_t undefined{};
};
[[nodiscard]] Spread spread_of(const std::vector<CaseResult>& results, std::size_t metric);

/// Over all cases in order.
[[nodiscard]] std::uint64_t digest_of(const std::vector<CaseResult>& results);

}  // namespace palp::lab
