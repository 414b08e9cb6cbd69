#include "judge/truth_judge.h"

#include <algorithm>
#include <cmath>

namespace palp::judge {
namespace {

constexpr std::size_t kStepTicks = 10;
constexpr Duration kBlackout = std::chrono::seconds{2};
constexpr double kAfterBlackout = 2;  ///< [s], still judged with it

PhaseTag tag_of(const PlantTruth& truth) {
  const bool known = truth.phase_kind <= static_cast<std::uint32_t>(PhaseKind::Drag);
  return {.kind = known ? static_cast<PhaseKind>(truth.phase_kind) : PhaseKind::Other,
          .site = site_at(truth.phase_place),
          .place = truth.phase_place,
          .index = static_cast<int>(truth.phase_index),
          .elapsed = seconds(truth.script_time - truth.phase_began),
          .duration = seconds(truth.phase_duration)};
}

}  // namespace

std::optional<RunTick> TruthJudge::look(const PlantTruth& truth, bool told_short) {
  if (truth.guarded) {
    step_max_ = std::max(step_max_, force_step(truth.hand_force));
  } else {
    forces_.clear();
  }
  work_min_ = std::min(work_min_, truth.hand_work);
  net_min_ = std::min(net_min_, truth.hand_work - truth.tissue_energy);
  pauses_.look({.held = truth.held,
                .resumed = truth.resumed,
                .guarded = truth.guarded,
                .force = truth.hand_force,
                .force_true = truth.force_true,
                .work = truth.hand_work,
                .position = truth.hand});
  if (truth.dark && !dark_seen_) {
    dark_seen_ = true;
    const double from = seconds(truth.run_time);
    run_.blackout(from, from + seconds(kBlackout) + kAfterBlackout);
  }
  if (!truth.performing) return std::nullopt;
  const RunTick tick{.at = seconds(truth.run_time),
                     .phase = tag_of(truth),
                     .counted = truth.counted,
                     .hand = truth.hand,
                     .surface = truth.surface,
                     .hand_velocity = truth.hand_velocity,
                     .hand_force = truth.hand_force,
                     .force_true = truth.force_true,
                     .contact_force = truth.contact_force,
                     .tip = truth.tip,
                     .tip_velocity = truth.tip_velocity,
                     .tip_place = truth.tip_place,
                     .told_short = told_short,
                     .energy_operator = truth.hand_work,
                     .energy_operator_min = work_min_,
                     .energy_net_min = net_min_};
  run_.look(tick);
  return tick;
}

double TruthJudge::force_step(double force) {
  forces_.push_back(force);
  if (forces_.size() > kStepTicks + 1) forces_.pop_front();
  return std::abs(force - forces_.front());
}

RunMetrics TruthJudge::metrics() const {
  RunMetrics metrics = run_.metrics();
  metrics.whole = {.force_step = step_max_,
                   .force_kick = pauses_.kick(),
                   .force_drop = pauses_.drop(),
                   .force_unexplained = pauses_.unexplained(),
                   .energy_given = pauses_.energy_given()};
  // Energy has no script: what the hand gets while it waits or lets go counts too.
  metrics.energy_operator = std::max(0.0, -work_min_);
  metrics.energy_net = std::max(0.0, -net_min_);
  return metrics;
}

}  // namespace palp::judge
