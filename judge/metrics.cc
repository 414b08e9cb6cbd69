#include "judge/metrics.h"

#include "judge/run_judge.h"

namespace palp::judge {

RunMetrics metrics_of(const std::vector<RunTick>& ticks, const MetricsConfig& config) {
  RunJudge judge{config};
  for (const RunTick& tick : ticks) judge.look(tick);
  return judge.metrics();
}

}  // namespace palp::judge
