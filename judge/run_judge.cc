#include "judge/run_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "common/core/conventions.h"

namespace palp::judge {
namespace {

constexpr double kUnstableSwing = 1.0 * kMillimetre;    ///< [m], in the second half of a hold
constexpr double kUnstableCycle = 0.5 * kMillimetre;    ///< [m], of a limit cycle, anywhere
constexpr double kUnstableCapTime = 0.2;                ///< [s], at the force cap in total
constexpr double kUnstablePosition = 60 * kMillimetre;  ///< [m]
constexpr double kUnstableSpeed = 3.0;                  ///< [m/s]
constexpr double kFreeAirTail = 3.0;                    ///< [s]
constexpr double kContactForce = 0.1;                   ///< [N], two steps of the transducer
constexpr double kLearningDepth = 1.0 * kMillimetre;    ///< [m]
constexpr double kLearningForce = 0.02;                 ///< [N]
constexpr double kLearningShare = 0.1;                  ///< [-]
constexpr double kLearningTime = 0.05;                  ///< [s], of right force
constexpr double kInTheAir = -1.5 * kMillimetre;        ///< [m]

void add(FeltStiffness& stiffness, const RunTick& tick) {
  stiffness.add(tick.hand, tick.hand_velocity, tick.hand_force, tick.force_true);
}

void judge_ratio(const FeltStiffness& a, const FeltStiffness& b, RunMetrics& metrics) {
  if (!a.error() || !b.error()) return;
  const double felt = *b.felt() / *a.felt();
  metrics.ratio_true = *b.truth() / *a.truth();
  metrics.ratio_error = felt / metrics.ratio_true - 1;
  metrics.contrast = (felt - 1) / (metrics.ratio_true - 1);
}

struct Secants {
  double felt{kUndefined};   ///< [N/m]
  double truth{kUndefined};  ///< [N/m]
};

Secants secants(const PhaseAccount::HoldMeans& shallow, const PhaseAccount::HoldMeans& deep) {
  const double span = deep.position - shallow.position;
  return {(deep.felt - shallow.felt) / span, (deep.truth - shallow.truth) / span};
}

/// `end`: of the hand or of the tip.
void call_unstable(RunMetrics& metrics, bool is, bool& end, const char* reason) {
  if (!is) return;
  metrics.unstable = end = true;
  metrics.unstable_reason = reason;
}

}  // namespace

void PhaseAccount::begin(const RunTick& tick) {
  *this = {};
  tag_ = tick.phase;
  began_at_ = tick.at;
  hand_max_ = -std::numeric_limits<double>::infinity();
  sums_ = {0, 0, 0};
}

bool PhaseAccount::holds(const PhaseTag& tag) const noexcept {
  const auto key = [](const PhaseTag& of) {
    return std::tuple{of.kind, of.place.x, of.place.y, of.index};
  };
  return key(tag) == key(tag_);
}

void PhaseAccount::look(const RunTick& tick) {
  ended_at_ = tick.at;
  hand_max_ = std::max(hand_max_, tick.hand);
  if (!tick.counted) return;
  const PhaseTag& phase = tick.phase;
  add(stiffness_, tick);
  if (phase.elapsed >= 0.5 * phase.duration) {
    hand_.look(tick.hand + tick.surface);
    tip_.look(tick.tip + tick.surface);
    surface_.look(tick.surface);
  }
  if (phase.elapsed >= 0.6 * phase.duration) {
    sums_.position += tick.hand;
    sums_.felt += tick.hand_force;
    sums_.truth += tick.force_true;
    ++hold_count_;
  }
  if (phase.elapsed >= 0.8 * phase.duration) {
    apart_ += std::abs(tick.tip - tick.hand);
    ++apart_count_;
  }
}

TapMetrics PhaseAccount::tap() const noexcept {
  return {.site = tag_.site,
          .place = tag_.place,
          .index = tag_.index,
          .began_at = began_at_,
          .ended_at = ended_at_,
          .hand_max = hand_max_,
          .stiffness = stiffness_};
}

PhaseAccount::HoldMeans PhaseAccount::hold() const noexcept {
  return {sums_.position / hold_count_, sums_.felt / hold_count_, sums_.truth / hold_count_};
}

void RunJudge::look(const RunTick& tick) {
  look_at_phase(tick);
  look_at_stability(tick);
  look_at_forces(tick);
  look_at_blackout(tick);
  if (tick.counted) {
    drag_.look(tick.at, tick.phase.kind == PhaseKind::Drag, tick.hand_force, tick.contact_force);
  }
  look_at_learning(tick, Site::A);
  look_at_learning(tick, Site::B);
  announcement_.look({.at = tick.at,
                      .felt = tick.hand_force,
                      .truth = tick.counted ? tick.force_true : 0,
                      .velocity = tick.hand_velocity,
                      .told = tick.told_short});
  energy_.look({.at = tick.at,
                .felt = tick.hand_force,
                .truth = tick.force_true,
                .work = tick.energy_operator});
  energy_operator_min_ = tick.energy_operator_min;
  energy_net_min_ = tick.energy_net_min;
  ++ticks_;
}

void RunJudge::blackout(double from, double to) noexcept {
  config_.blackout_from = from;
  config_.blackout_to = to;
}

void RunJudge::look_at_phase(const RunTick& tick) {
  if (ticks_ == 0 || !phase_.holds(tick.phase)) {
    end_phase();
    phase_.begin(tick);
  }
  phase_.look(tick);
  const PhaseTag& tag = phase_.tag();
  if (!tick.counted || tag.kind != PhaseKind::Tap) return;
  tap_square_ += (tick.hand_force - tick.force_true) * (tick.hand_force - tick.force_true);
  ++tap_count_;
  if (tag.site != Site::Other && tag.index >= 2) {
    add(pooled_[static_cast<std::size_t>(tag.site)], tick);
  }
}

void RunJudge::end_phase() {
  if (ticks_ == 0) return;
  const PhaseTag& tag = phase_.tag();
  const bool held = tag.kind == PhaseKind::PressHold || tag.kind == PhaseKind::LiftHold;
  if (held && phase_.swing() >= kUnstableSwing) swings_ = true;
  if (held && phase_.tip_swing() >= kUnstableSwing) tip_swings_ = true;
  const auto site = static_cast<std::size_t>(tag.site);
  if (tag.kind == PhaseKind::Tap) {
    metrics_.taps.push_back(phase_.tap());
    const double error = metrics_.taps.back().stiffness.error().value_or(kUndefined);
    if (tag.site != Site::Other) known_[site].tap(metrics_.taps.back());
    // At a later visit the law knows the place.
    const auto taps = std::span{metrics_.taps};
    const bool later = std::ranges::any_of(taps.first(taps.size() - 1), [&](const TapMetrics& tap) {
      return tap.site == tag.site && tap.index == tag.index;
    });
    if (tag.site != Site::Other && tag.index == 1 && !later) metrics_.tap1_error[site] = error;
    if (tag.site != Site::Other && tag.index == 2 && !later) metrics_.tap2_error[site] = error;
  }
  if (tag.kind == PhaseKind::PressHold && tag.site != Site::Other &&
      (tag.index == 1 || tag.index == 2)) {
    holds_[site][static_cast<std::size_t>(tag.index - 1)] = phase_.hold();
  }
  if (tag.kind == PhaseKind::PressHold && tag.site != Site::Other) {
    const PhaseAccount::HoldMeans means = phase_.hold();
    known_[site].hold({.from = phase_.held_from(),
                       .until = phase_.ended_at(),
                       .position = means.position,
                       .felt = means.felt,
                       .truth = means.truth});
  }
  if (tag.kind == PhaseKind::LiftHold && tag.site == Site::B) metrics_.drift = phase_.drift();
}

void RunJudge::look_at_stability(const RunTick& tick) {
  // A sine in the air may be meant to be quick, and what moves while the session is broken off is
  // no loop.
  if (!tick.counted || tick.phase.kind == PhaseKind::FreeAir) {
    hand_swing_.restart();
    tip_swing_.restart();
  } else {
    hand_swing_.look({tick.at, tick.hand, -tick.energy_operator});
    tip_swing_.look({tick.at, tick.tip});
  }
  if (!tick.counted) return;
  if (std::abs(tick.hand_force) >= config_.force_cap * (1 - 1e-9)) at_cap_ += config_.period;
  if (!(std::abs(tick.hand) <= kUnstablePosition) ||
      !(std::abs(tick.hand_velocity) <= kUnstableSpeed)) {
    ran_away_ = true;
  }
}

/// How long the force at a new site is wrong.
void RunJudge::look_at_learning(const RunTick& tick, Site site) {
  Learning& learning = learning_[static_cast<std::size_t>(site)];
  const bool here = tick.phase.site == site && tick.phase.kind != PhaseKind::FreeAir;
  if (here && tick.counted) {
    const PermittedPress::Look hand{.at = tick.at,
                                    .felt = tick.hand_force,
                                    .truth = tick.force_true,
                                    .position = tick.hand,
                                    .work = tick.energy_operator};
    first_press_[static_cast<std::size_t>(site)].look(hand);
    known_[static_cast<std::size_t>(site)].feel(hand);
    known_[static_cast<std::size_t>(site)].look(tick.at, tick.tip, tick.contact_force);
  }
  if (!here || !tick.counted || !std::isnan(learning.took)) return;
  if (std::isnan(learning.began_at) && tick.contact_force >= kContactForce) {
    learning.began_at = tick.at;
  }
  if (std::isnan(learning.began_at) || tick.hand <= kLearningDepth) return;
  const double allowed = std::max(kLearningForce, kLearningShare * tick.force_true);
  const bool right = std::abs(tick.hand_force - tick.force_true) <= allowed;
  learning.right_for = right ? learning.right_for + config_.period : 0;
  if (learning.right_for >= kLearningTime) learning.took = tick.at - learning.began_at;
}

void RunJudge::look_at_blackout(const RunTick& tick) {
  if (config_.blackout_to <= config_.blackout_from) return;
  if (tick.at < config_.blackout_from || tick.at > config_.blackout_to) return;
  if (std::isnan(metrics_.phantom_force)) metrics_.phantom_force = metrics_.stage_speed_max = 0;
  if (tick.hand < kInTheAir) {
    metrics_.phantom_force = std::max(metrics_.phantom_force, std::abs(tick.hand_force));
  }
  metrics_.stage_speed_max = std::max(metrics_.stage_speed_max, std::abs(tick.tip_velocity));
}

void RunJudge::look_at_forces(const RunTick& tick) {
  metrics_.force_peak = std::max(metrics_.force_peak, std::abs(tick.hand_force));
  metrics_.contact.force_max = std::max(metrics_.contact.force_max, tick.contact_force);
  guard_.look(tick.at, tick.contact_force);
  Forces& slot = before_[ticks_ % kStepTicks];
  // Across a break of the session there is no step.
  if (ticks_ >= kStepTicks && tick.at - slot.at < (kStepTicks + 0.5) * config_.period) {
    const double step = tick.hand_force - slot.felt;
    const double unexplained = step - (tick.force_true - slot.truth);
    metrics_.force_step_10ms = std::max(metrics_.force_step_10ms, std::abs(step));
    metrics_.force_step_event =
        std::max(metrics_.force_step_event, std::min(std::abs(step), std::abs(unexplained)));
  }
  slot = {tick.at, tick.hand_force, tick.force_true};
  const bool in_air = tick.counted && tick.phase.kind == PhaseKind::FreeAir &&
                      tick.phase.elapsed >= tick.phase.duration - kFreeAirTail;
  if (!in_air) return;
  air_.square += tick.hand_force * tick.hand_force;
  air_.peak = std::max(air_.peak, std::abs(tick.hand_force));
  ++air_.count;
}

RunMetrics RunJudge::metrics() const {
  RunJudge whole = *this;
  whole.end_phase();
  whole.sum_up();
  return whole.metrics_;
}

void RunJudge::sum_up() {
  if (ticks_ == 0) return;
  sum_up_stability();
  metrics_.tap_error[0] = pooled_[0].error().value_or(kUndefined);
  metrics_.tap_error[1] = pooled_[1].error().value_or(kUndefined);
  judge_ratio(pooled_[0], pooled_[1], metrics_);
  const Secants a = secants(holds_[0][0], holds_[0][1]);
  const Secants b = secants(holds_[1][0], holds_[1][1]);
  metrics_.static_error[0] = a.felt / a.truth - 1;
  metrics_.static_error[1] = b.felt / b.truth - 1;
  metrics_.static_ratio_error = b.felt / a.felt / (b.truth / a.truth) - 1;
  if (air_.count > 0) {
    metrics_.drag_rms = std::sqrt(air_.square / air_.count);
    metrics_.drag_peak = air_.peak;
  }
  metrics_.energy_operator = std::max(0.0, -energy_operator_min_);
  metrics_.energy_net = std::max(0.0, -energy_net_min_);
  metrics_.contact.announced = announcement_.share();
  metrics_.contact.told_in_vain = announcement_.in_vain();
  metrics_.contact.guard_excess = guard_.excess();
  metrics_.contact.guard_excess_time = guard_.longest();
  metrics_.contact.energy_contact = energy_.in_contact();
  metrics_.contact.energy_air_to_air = energy_.air_to_air();
  metrics_.force_rms = std::sqrt(tap_square_ / tap_count_);
  for (std::size_t site = 0; site < known_.size(); ++site) {
    metrics_.contact.known_tap_error[site] = known_[site].tap_error();
    metrics_.contact.held_error[site] = known_[site].held_error();
  }
  sum_up_first_presses();
  metrics_.contact.drag_error = drag_.error();
  metrics_.contact.drag_shift = drag_.shift();
  metrics_.contact.drag_felt = drag_.felt();
  metrics_.learning[0] = learning_[0].took;
  metrics_.learning[1] = learning_[1].took;
  // Asked for, and nothing of it was seen.
  if (config_.blackout_to > config_.blackout_from && std::isnan(metrics_.phantom_force)) {
    metrics_.phantom_force = metrics_.stage_speed_max = 0;
  }
}

void RunJudge::sum_up_stability() {
  bool& hand = metrics_.contact.unstable_hand;
  bool& tip = metrics_.contact.unstable_tip;
  call_unstable(
      metrics_, tip_swings_, tip, "the tip swings by 1 mm or more under a hand that holds");
  call_unstable(metrics_, swings_, hand, "the hand swings by 1 mm or more in a hold");
  metrics_.contact.hand_swing = hand_swing_.largest();
  metrics_.contact.tip_swing = tip_swing_.largest();
  // A light hand that taps on something stiff bounces there with its own finger too, which is hand
  // and tip in one.
  const double unstable = config_.own_swing + kUnstableCycle;
  const bool cycles = metrics_.contact.hand_swing >= unstable;
  call_unstable(metrics_, cycles, hand, "the hand swings by itself");
  const bool tip_cycles = metrics_.contact.tip_swing >= unstable;
  call_unstable(metrics_, tip_cycles, tip, "the tip swings by itself");
  call_unstable(metrics_, ran_away_, hand, "the hand ran away");
  const bool at_limit = at_cap_ >= kUnstableCapTime;
  call_unstable(metrics_, at_limit, hand, "the force stayed at the device's limit for 0.2 s");
}

/// Of the site whose share falls farthest below what is permitted; where nobody knows, all is.
void RunJudge::sum_up_first_presses() {
  double most = -std::numeric_limits<double>::infinity();  // [-]
  for (const FirstPress& press : first_press_) {
    const double share = press.share();
    const double permitted = press.permitted();
    const double missing = (std::isnan(permitted) ? 1 : permitted) - share;
    if (!(missing > most)) continue;
    most = missing;
    metrics_.contact.share_2s = share;
    metrics_.contact.share_permitted = permitted;
    metrics_.contact.share_given = press.given();
  }
}

}  // namespace palp::judge
