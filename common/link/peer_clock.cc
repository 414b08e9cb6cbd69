#include "common/link/peer_clock.h"

#include <algorithm>

namespace palp::link {

void RecentMinimum::add(Duration value, TimePoint at) noexcept {
  const std::int64_t second = second_of(at);
  Bin& bin = bins_[static_cast<std::size_t>(((second % kSeconds) + kSeconds) % kSeconds)];
  if (!bin.used || bin.second < second) {
    bin = {second, value, true};
  } else if (bin.second == second) {
    bin.least = std::min(bin.least, value);
  }
  if (!least_ || second > newest_second_) {
    newest_second_ = second;
    least_ = search(second);
  } else if (second > newest_second_ - kSeconds) {
    least_ = std::min(*least_, value);
  }
}

std::optional<Duration> RecentMinimum::search(std::int64_t second) const noexcept {
  std::optional<Duration> least;
  for (const Bin& bin : bins_) {
    if (!bin.used || bin.second <= second - kSeconds) continue;
    least = least ? std::min(*least, bin.least) : bin.least;
  }
  return least;
}

std::optional<Duration> RecentMinimum::least(TimePoint now) const noexcept {
  const std::int64_t second = second_of(now);
  return second == newest_second_ ? least_ : search(second);
}

bool PeerClock::add_round_trip(TimePoint echo, Duration hold, TimePoint arrived_at) noexcept {
  const Duration round_trip = (arrived_at - echo) - hold;
  // The hold is told in whole microseconds: on a link without delay it may round past zero.
  constexpr Duration kHoldResolution = std::chrono::microseconds{1};
  if (round_trip < -kHoldResolution) return false;
  const Duration value = std::max(round_trip, Duration{0});
  round_trip_.add(value, arrived_at);
  if (!measured_) {  // first values as in RFC 6298
    measured_ = true;
    smoothed_ = value;
    deviation_ = value / 2;
  } else {
    deviation_ += (std::chrono::abs(value - smoothed_) - deviation_) / 4;
    smoothed_ += (value - smoothed_) / 8;
  }
  return true;
}

Duration PeerClock::add_one_way(Duration relative, TimePoint arrived_at) noexcept {
  one_way_.add(relative, arrived_at);
  return relative - *one_way_.least(arrived_at);
}

Duration PeerClock::least(TimePoint now) const noexcept {
  return round_trip_.least(now).value_or(smoothed_);
}

}  // namespace palp::link
