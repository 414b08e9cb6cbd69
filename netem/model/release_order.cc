#include "netem/model/release_order.h"

#include <algorithm>

namespace palp::netem {

TimePoint ReleaseOrder::fit_swapped(TimePoint release, TimePoint arrived, bool swaps) noexcept {
  const std::uint64_t depth = std::min<std::uint64_t>(swap_depth_, released_);
  const TimePoint overtaken =
      depth > 0 ? releases_[(released_ - depth) % kSwapDepthMax] : TimePoint::min();
  if (swaps && overtaken > arrived) return std::max(overtaken - Duration{1}, arrived);
  last_ = std::max(release, last_);
  releases_[released_++ % kSwapDepthMax] = last_;
  return last_;
}

}  // namespace palp::netem
