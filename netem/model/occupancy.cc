#include "netem/model/occupancy.h"

#include <algorithm>
#include <functional>

namespace palp::netem {

void Occupancy::enter(TimePoint release) {
  line_.push_back(release);
  if (sorted_) std::push_heap(line_.begin(), line_.end(), std::greater<>{});
}

std::size_t Occupancy::counted_room(TimePoint gone, std::size_t wanted) noexcept {
  if (sorted_) {
    while (!line_.empty() && line_.front() <= gone) {
      std::pop_heap(line_.begin(), line_.end(), std::greater<>{});
      line_.pop_back();
    }
    if (line_.size() < most_ / 2) sorted_ = false;
  } else {
    while (first_ < line_.size() && line_[first_] <= gone) ++first_;
    const bool short_of_room = line_.size() - first_ + wanted > most_;
    if (short_of_room || line_.size() >= tidy_at_) tidy(gone);
  }
  const std::size_t taken = line_.size() - first_;
  return taken < most_ ? std::min(most_ - taken, wanted) : 0;
}

/// Looks at everybody, and no sooner again than the line has doubled or, where it is long because
/// few have left, never: from then on it is kept in order.
void Occupancy::tidy(TimePoint gone) noexcept {
  const auto begin = line_.begin() + static_cast<std::ptrdiff_t>(first_);
  const auto end =
      std::remove_if(begin, line_.end(), [gone](TimePoint release) { return release <= gone; });
  line_.erase(std::move(begin, end, line_.begin()), line_.end());
  first_ = 0;
  tidy_at_ = std::max(kTidyAt, 2 * line_.size());
  if (line_.size() <= most_ / 2) return;
  std::make_heap(line_.begin(), line_.end(), std::greater<>{});
  sorted_ = true;
}

}  // namespace palp::netem
