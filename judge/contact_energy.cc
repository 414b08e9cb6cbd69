#include "judge/contact_energy.h"

#include <algorithm>
#include <utility>

namespace palp::judge {

void ContactEnergy::look(const Look& now) noexcept {
  if (!std::exchange(begun_, true)) work_before_ = now.work;
  if (now.truth > 0 || now.felt > (touches_ ? kLetGo : kFelt)) {
    touches_ = true;
    touched_at_ = now.at;
  }
  touches_ = touches_ && now.at < touched_at_ + kEnded;
  if (touches_) {
    in_contact_ = std::max(in_contact_, work_before_ - now.work);
    return;
  }
  work_before_ = now.work;
  work_most_ = std::max(work_most_, now.work);
  air_to_air_ = std::max(air_to_air_, work_most_ - now.work);
}

}  // namespace palp::judge
