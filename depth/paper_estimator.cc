#include "depth/paper_estimator.h"

#include "common/core/check.h"
#include "depth/paper_hash.h"

namespace palp::depth {

PaperEstimator::PaperEstimator(const PaperEstimatorConfig& config) : config_{config} {
  PALP_CHECK(config.indentation_min > 0, "a stroke has a length");
}

DepthEstimate PaperEstimator::judge(const Stroke& stroke) const noexcept {
  DepthEstimate estimate = unjudged(stroke);
  if (stroke.reason != DepthReason::Ok) return estimate;
  if (stroke.indentation_max < config_.indentation_min) {
    estimate.reason = DepthReason::StrokeTooShort;
    return estimate;
  }
  const HashVerdict verdict = judge_hash(stroke.hash);
  estimate.verdict = verdict.verdict;
  estimate.reason = verdict.reason;
  estimate.depth = verdict.depth;
  estimate.depth_low = verdict.depth;
  estimate.depth_high = verdict.depth;
  return estimate;
}

}  // namespace palp::depth
