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
  held_.felt += now.felt;
  held_.truth += now.truth;
  held_.position += now.position;
  ++looks_;
  over_ = settled_ = since >= settled_after_ + kWindow;
}

double FirstPress::share() const noexcept {
  return settled_ ? held_.felt / held_.truth : std::numeric_limits<double>::quiet_NaN();
}

double FirstPress::given() const noexcept {
  const PermittedPress::Permitted permitted = most();
  const bool all = permitted.share >= PermittedPress::kAll;
  return all ? std::numeric_limits<double>::quiet_NaN() : held_.felt / looks_ / permitted.force;
}

PermittedPress::Permitted FirstPress::most() const noexcept {
  if (!settled_) return {};
  return press_.permitted({.at = began_at_ + settled_after_,
                           .felt = held_.felt / looks_,
                           .truth = held_.truth / looks_,
                           .position = held_.position / looks_});
}

}  // namespace palp::judge
