#include "netem/model/normal_draw.h"

namespace palp::netem {

NormalDraw::NormalDraw() noexcept : knots_{} {
  for (std::size_t i = kOuter; i <= kCells - kOuter; ++i) {
    knots_[i] = static_cast<float>(normal_quantile(static_cast<double>(i) / kCells));
  }
}

}  // namespace palp::netem
