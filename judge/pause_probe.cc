#include "judge/pause_probe.h"

#include <algorithm>
#include <cmath>

namespace palp::judge {
namespace {

constexpr double kStiffest = 650;  // [N/m], the spring of the tanks

}  // namespace

void PauseProbe::look(const Look& now) {
  const double taken = std::max(0.0, -now.work);
  // The last stretch of a pause is seen once it is over.
  const bool held = now.held || held_before_;
  held_before_ = now.held;
  excused_ = held ? std::max(excused_, taken) : std::min(excused_, taken);
  if (now.held) return;
  energy_given_ = std::max(energy_given_, taken - excused_);

  if (!now.guarded) {
    past_.clear();
    judged_for_ = 0;
    return;
  }
  past_.push_back({now.force, now.force - now.force_true, now.position});
  if (past_.size() > kMemory + 1) past_.pop_front();
  if (now.resumed) judged_for_ = kAfter;
  if (judged_for_ == 0) return;
  --judged_for_;
  judge();
}

double PauseProbe::way(double sign) const {
  double sum = 0;
  for (std::size_t i = 1; i < past_.size(); ++i) {
    sum += std::max(0.0, sign * (past_[i].position - past_[i - 1].position));
  }
  return sum;
}

void PauseProbe::judge() {
  const Instant& now = past_.back();
  const Instant& before = past_[past_.size() - 1 - std::min(past_.size() - 1, kWindow)];
  const double change = now.felt - before.felt;
  const double kick = std::min(std::abs(change), std::abs(now.less - before.less));
  double& worst = std::abs(now.felt) > std::abs(before.felt) ? kick_ : drop_;
  worst = std::max(worst, kick);
  const double explained = kStiffest * way(change > 0 ? 1 : -1);
  unexplained_ = std::max(unexplained_, std::min(kick, std::abs(change) - explained));
}

}  // namespace palp::judge
