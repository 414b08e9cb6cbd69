#include "netem/occupancy.h"

#include <algorithm>

namespace palp::netem {

/// Those in front who have left are passed over; if that is not enough, everybody is looked at.
std::size_t Occupancy::counted_room(TimePoint gone, std::size_t wanted) noexcept {
  while (first_ < line_.size() && line_[first_] <= gone) ++first_;
  if (line_.size() - first_ + wanted > most_ || line_.size() >= kTidyAt) {
    const auto begin = line_.begin() + static_cast<std::ptrdiff_t>(first_);
    const auto end =
        std::remove_if(begin, line_.end(), [gone](TimePoint release) { return release <= gone; });
    line_.erase(std::move(begin, end, line_.begin()), line_.end());
    first_ = 0;
  }
  const std::size_t taken = line_.size() - first_;
  return taken < most_ ? std::min(most_ - taken, wanted) : 0;
}

}  // namespace palp::netem
