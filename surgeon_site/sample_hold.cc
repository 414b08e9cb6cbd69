#include "surgeon_site/sample_hold.h"

#include <algorithm>

namespace palp::surgeon {

std::span<const Incoming> SampleHold::pass(std::span<const Incoming> arrived,
                                           Duration wanted,
                                           TimePoint now) noexcept {
  const Duration step = from_seconds(kSlew * seconds(now - ticked_at_));
  wanted = std::clamp(wanted, Duration{0}, kMax);
  hold_ = std::clamp(wanted, hold_ - step, hold_ + step);
  ticked_at_ = now;

  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(passed_));
  passed_ = 0;
  if (waiting_.empty() && hold_ == Duration{0}) return arrived;
  if (waiting_.size() + arrived.size() > kKept) {
    // A bunch after a pause: the newest that there is room for say all that the law still needs.
    const std::size_t room = kKept - std::min(kKept, arrived.size());
    if (waiting_.size() > room) {
      waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(room));
    }
    arrived = arrived.last(std::min(arrived.size(), kKept));
  }
  waiting_.insert(waiting_.end(), arrived.begin(), arrived.end());
  const auto due = std::find_if(waiting_.begin(), waiting_.end(), [&](const Incoming& one) {
    return now - one.arrived_at < hold_;
  });
  passed_ = static_cast<std::size_t>(due - waiting_.begin());
  return std::span{waiting_}.first(passed_);
}

void SampleHold::forget() noexcept {
  waiting_.clear();
  passed_ = 0;
}

}  // namespace palp::surgeon
