#include "judge/announcement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::judge {

bool Announcement::is_short(const Look& now) noexcept {
  const bool touches = now.truth > kContact;
  if (touches && !std::exchange(touches_, touches)) touched_at_ = now.at;
  touches_ = touches;
  if (!touches || !(std::abs(now.velocity) < kRest)) return false;
  if (now.at < touched_at_ + round_trip_) return false;
  return now.truth - now.felt > std::max(kLeast, kShare * now.truth);
}

void Announcement::look(const Look& now) noexcept {
  const bool before = std::exchange(short_, is_short(now));
  if (!short_) return;
  if (!before) {
    short_from_ = now.at;
    counted_ = told_ = false;
  }
  if (counted_) return;
  told_ = told_ || now.told;
  if (now.at < short_from_ + kLasts) return;
  counted_ = true;
  ++count_;
  if (told_) ++announced_;
}

}  // namespace palp::judge
