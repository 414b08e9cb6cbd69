#pragma once

#include "common/message/depth.h"
#include "depth/stroke.h"

namespace palp::depth {

struct PaperEstimatorConfig {
  double indentation_min{2.5e-3};  ///< [m], a shorter stroke says nothing on eq. (2) over 4 mm
};

/// The paper's estimator: the hash h of a stroke's cubic (2) over 0 to 4 mm of indentation, and the
/// depth by (3) with the paper's coefficients. A value. Thread: estimator.
class PaperEstimator {
 public:
  explicit PaperEstimator(const PaperEstimatorConfig& config);

  [[nodiscard]] DepthEstimate judge(const Stroke& stroke) const noexcept;

 private:
  PaperEstimatorConfig config_;
};

}  // namespace palp::depth
