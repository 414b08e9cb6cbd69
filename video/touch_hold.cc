#include "video/touch_hold.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace palp::video {

void TouchHold::add(Duration age, Duration way) {
  behind_.push_back(age - way);
  if (behind_.size() > kPictures) behind_.pop_front();
  fresh_ = true;
}

Duration TouchHold::wanted(TimePoint now) {
  if (std::exchange(fresh_, false)) fresh_at_ = now;
  if (now - fresh_at_ > kNone) behind_.clear();
  if (behind_.empty()) return wanted_ = Duration{0};
  if (wanted_ != Duration{0} && now - anew_at_ < kAnew) return wanted_;
  anew_at_ = now;
  std::vector<Duration> sorted(behind_.begin(), behind_.end());
  const auto most = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 19 / 20);
  std::nth_element(sorted.begin(), most, sorted.end());
  return wanted_ = std::clamp(*most + kShowing, Duration{0}, kMax);
}

}  // namespace palp::video
