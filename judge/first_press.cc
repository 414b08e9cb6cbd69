#include "judge/first_press.h"

#include <limits>
#include <utility>

namespace palp::judge {

void FirstPress::look(const Look& now) {
  if (over_) return;
  if (now.truth < kContact) {
    over_ = begun_;
    return;
  }
  if (!std::exchange(begun_, true)) {
    began_at_ = now.at;
    press_.begin(now);
  }
  press_.look(now);
  const double since = now.at - began_at_;
  if (since < settled_after_) return;
  felt_ += now.felt;
  truth_ += now.truth;
  over_ = settled_ = since >= settled_after_ + kWindow;
}

double FirstPress::share() const noexcept {
  return settled_ ? felt_ / truth_ : std::numeric_limits<double>::quiet_NaN();
}

double FirstPress::permitted() const noexcept {
  return settled_ ? press_.permitted(began_at_ + settled_after_)
                  : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace palp::judge
