#include "judge/pause_probe.h"

#include <algorithm>
#include <cmath>

namespace palp::judge {

void PauseProbe::look(const Look& now) {
  const double taken = std::max(0.0, -now.work);
  // The last stretch of a pause is seen once it is over.
  const bool held = now.held || held_before_;
  held_before_ = now.held;
  excused_ = held ? std::max(excused_, taken) : std::min(excused_, taken);
  if (now.held) return;
  energy_given_ = std::max(energy_given_, taken - excused_);

  if (!now.guarded) {
    forces_.clear();
    judged_for_ = 0;
    return;
  }
  forces_.push_back({now.force, now.force - now.force_true});
  if (forces_.size() > kWindow + 1) forces_.pop_front();
  if (now.resumed) judged_for_ = kAfter;
  if (judged_for_ == 0) return;
  --judged_for_;
  const Forces& before = forces_.front();
  const double change = now.force - before.felt;
  const double unexplained =
      std::min(std::abs(change), std::abs(forces_.back().less - before.less));
  double& worst = std::abs(now.force) > std::abs(before.felt) ? kick_ : drop_;
  worst = std::max(worst, unexplained);
}

}  // namespace palp::judge
