#include "lab/plan/batch.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>

#include "judge/metric_table.h"
#include "lab/run/digest.h"
#include "lab/run/run.h"

namespace palp::lab {
namespace {

/// As the rows of a cases file have it, so that merged shards come to the same numbers as the
/// whole.
double nine_digits(double value) {
  if (!std::isfinite(value)) return value;
  std::array<char, 32> text{};
  const int size = std::snprintf(text.data(), text.size(), "%.9g", value);
  double rounded = value;
  (void)std::from_chars(text.data(), text.data() + size, rounded);
  return rounded;
}

CaseResult result_of(const Case& one, const Scenario& scenario) {
  const RunResult run = simulate(scenario);
  CaseResult result;
  result.index = one.index;
  result.seed = one.seed;
  result.labels = one.labels;
  result.digest = run.digest;
  result.virtual_span = seconds(run.virtual_span);
  result.outcome = surgeon::to_string(run.outcome);
  result.unstable = run.metrics.unstable;
  result.unstable_reason = run.metrics.unstable_reason;
  for (const judge::Metric& metric : judge::metric_table()) {
    result.values.push_back(nine_digits(metric.value(run.metrics)));
  }
  return result;
}

}  // namespace

Result<std::vector<CaseResult>> run_plan(const Plan& plan,
                                         const ForEach& for_each,
                                         const Progress& progress,
                                         const CaseSink& sink) {
  std::vector<CaseResult> results(plan.cases.size());
  std::mutex mutex;  // of the next two, of sink and of progress
  std::size_t done = 0;
  std::optional<Error> first_error;
  std::atomic<bool> failed{false};
  for_each(plan.cases.size(), [&](std::size_t i) {
    if (failed) return;
    const auto scenario = make_case(plan, plan.cases[i]);
    if (scenario) results[i] = result_of(plan.cases[i], *scenario);
    const std::lock_guard lock{mutex};
    if (!scenario && !first_error) first_error = scenario.error();
    if (!scenario) failed = true;
    if (scenario && sink) sink(results[i]);
    if (progress) progress(++done, plan.cases.size());
  });
  if (first_error) return tl::unexpected(*first_error);
  return results;
}

Spread spread_of(const std::vector<CaseResult>& results, std::size_t metric) {
  Spread spread;
  std::vector<double> values;
  for (const CaseResult& result : results) {
    const double value = result.values[metric];
    if (std::isfinite(value)) {
      values.push_back(std::abs(value));
    } else {
      ++spread.undefined;
    }
  }
  if (results.empty()) return spread;
  std::sort(values.begin(), values.end());
  if (!values.empty()) spread.max = values.back();
  const auto at = [&](double p) {
    const auto n = static_cast<double>(results.size());
    const auto rank = static_cast<std::size_t>(std::min(n - 1, std::floor(p * n)));
    return rank < values.size() ? values[rank] : judge::kUndefined;
  };
  spread.p50 = at(0.5);
  spread.p90 = at(0.9);
  spread.p95 = at(0.95);
  spread.p99 = at(0.99);
  return spread;
}

std::uint64_t digest_of(const std::vector<CaseResult>& results) {
  Digest digest;
  for (const CaseResult& result : results) {
    digest.add(result.index);
    digest.add(result.digest);
  }
  return digest.value();
}

}  // namespace palp::lab
