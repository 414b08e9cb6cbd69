#include "video/standing_delay.h"

#include <algorithm>
#include <vector>

namespace palp::video {

void StandingDelay::add(std::uint64_t number, Duration one_way, TimePoint arrived_at) noexcept {
  if (!begun_) {
    begun_ = true;
    newest_ = number;
    step_ends_at_ = arrived_at + kStep;
  }
  if (number > newest_) {
    count_.expected += number - newest_;
    newest_ = number;
  }
  ++count_.arrived;
  least_[0] = std::min(least_[0], one_way);
}

void StandingDelay::step() {
  const Duration least = *std::min_element(least_.begin(), least_.end());
  if (least != Duration::max()) minima_.push_back(least);
  if (minima_.size() > kMinima) minima_.pop_front();
  std::rotate(least_.begin(), least_.begin() + 2, least_.end());
  least_[0] = Duration::max();
  counts_.push_back(count_);
  if (counts_.size() > kCounts) counts_.pop_front();
  step_ends_at_ += kStep;
}

Duration StandingDelay::standing() const {
  if (minima_.size() < 4) return Duration{0};
  std::vector<Duration> sorted{minima_.begin(), minima_.end()};
  std::sort(sorted.begin(), sorted.end());
  Duration noise{0};
  for (std::size_t i = 3; i < minima_.size(); ++i) {
    noise += std::chrono::abs(minima_[i] - minima_[i - 3]);
  }
  noise /= static_cast<std::int64_t>(minima_.size() - 3);
  const Duration base = sorted[sorted.size() / 20];
  return std::max(Duration{0}, minima_.back() - base - noise * 3 / 2);
}

StandingDelay::Reading StandingDelay::read(TimePoint now) {
  if (!begun_) return {};
  // After a long silence nothing of before counts.
  if (now - step_ends_at_ > kStep * static_cast<std::int64_t>(kMinima)) *this = {};
  while (begun_ && now >= step_ends_at_) step();
  if (counts_.empty()) return {.standing = standing()};
  return {.standing = standing(),
          .expected = counts_.back().expected - counts_.front().expected,
          .arrived = counts_.back().arrived - counts_.front().arrived};
}

}  // namespace palp::video
