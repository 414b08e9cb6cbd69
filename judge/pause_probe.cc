#include "judge/pause_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palp::judge {
namespace {

constexpr double kStiffest = 650;  // [N/m], the spring of the tanks
constexpr double kDamping = 15;    // [N s/m], the largest impedance of `wave`
constexpr double kTick = 1e-3;     // [s]

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

double PauseProbe::explained(double sign) const {
  double way = 0;
  double faster = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < past_.size(); ++i) {
    const double step = sign * (past_[i].position - past_[i - 1].position);
    way += std::max(0.0, step);
    least = std::min(least, step / kTick);
    faster = step / kTick - least;
  }
  return kStiffest * way + kDamping * faster;
}

void PauseProbe::judge() {
  const Instant& now = past_.back();
  const Instant& before = past_[past_.size() - 1 - std::min(past_.size() - 1, kWindow)];
  const double change = now.felt - before.felt;
  const double kick = std::min(std::abs(change), std::abs(now.less - before.less));
  double& worst = std::abs(now.felt) > std::abs(before.felt) ? kick_ : drop_;
  worst = std::max(worst, kick);
  const double left = std::abs(change) - explained(change > 0 ? 1 : -1);
  unexplained_ = std::max(unexplained_, std::min(kick, left));
}

}  // namespace palp::judge
