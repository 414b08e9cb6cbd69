#pragma once

#include <string>
#include <vector>

#include "common/plot/figure.h"
#include "lab/plan/batch.h"
#include "lab/plan/plan.h"
#include "lab/report/batch_report.h"

/// The stability of eq. (1) over springs, round trips and grips, whole or of a shard: what was not
/// run is left open.
namespace palp::lab {

/// palp.map/1; null: not run.
[[nodiscard]] std::string map_report(const Plan& plan,
                                     const std::vector<CaseResult>& results,
                                     const BatchAccount& account);
/// A picture: one square a run, rows of springs, columns of round trips, one panel per grip.
[[nodiscard]] plot::Figure map_figure(const std::vector<CaseResult>& results);
/// A line per grip and spring: S stable, . unstable, ? not run.
[[nodiscard]] std::string map_text(const std::vector<CaseResult>& results);

}  // namespace palp::lab
