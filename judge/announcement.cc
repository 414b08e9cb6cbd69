#include "judge/announcement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::judge {

bool Announcement::rests(const Look& now) noexcept {
  const bool touches = now.truth > kContact;
  if (touches && !std::exchange(touches_, touches)) touched_at_ = now.at;
  touches_ = touches;
  if (!touches || !(std::abs(now.velocity) < kRest)) return false;
  return now.at >= touched_at_ + round_trip_;
}

void Announcement::look(const Look& now) noexcept {
  const bool rested = rests(now);
  const bool is_short = rested && now.truth - now.felt > std::max(kLeast, kShare * now.truth);
  if (rested) ++rested_;
  if (rested && now.told && !is_short) ++in_vain_;
  const bool before = std::exchange(short_, is_short);
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
