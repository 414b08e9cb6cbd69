#include "judge/depth_statement.h"

#include "common/core/depth_text.h"

namespace palp::judge {

DepthStatement statement_of(const DepthEstimate& estimate) {
  DepthStatement out{.verdict = estimate.verdict,
                     .depth = {},
                     .low = {},
                     .high = {},
                     .stddev = {},
                     .excluded = {},
                     .says = depth_text_of(estimate)};
  if (estimate.verdict == DepthVerdict::Found) {
    out.depth = estimate.depth;
    if (estimate.depth_stddev > 0) out.stddev = estimate.depth_stddev;
    // An estimator that gives no interval has both ends at the depth.
    if (estimate.depth_low < estimate.depth_high) {
      out.low = estimate.depth_low;
      out.high = estimate.depth_high;
    }
  }
  if (estimate.verdict == DepthVerdict::None && estimate.depth_low > 0) {
    out.excluded = estimate.depth_low;
  }
  return out;
}

}  // namespace palp::judge
