#include "judge/first_press.h"

#include <utility>

namespace palp::judge {

void FirstPress::look(double at, double felt, double truth) noexcept {
  if (over_) return;
  if (truth < kContact) {
    over_ = begun_;
    return;
  }
  if (!std::exchange(begun_, true)) began_at_ = at;
  const double since = at - began_at_;
  if (since < kSettled) return;
  felt_ += felt;
  truth_ += truth;
  over_ = settled_ = since >= kSettled + kWindow;
}

double FirstPress::share() const noexcept {
  return settled_ ? felt_ / truth_ : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace palp::judge
