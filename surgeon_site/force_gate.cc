#include "surgeon_site/force_gate.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"
#include "common/core/limits.h"

namespace palp::surgeon {
namespace {

constexpr bool may_carry_force(SiteState state) noexcept {
  return state == SiteState::Engaged || state == SiteState::Hold || state == SiteState::Retract;
}

/// `force`, but no larger than `target` asks for, and 0 where that has the other sign.
constexpr double nearer_to_zero(double force, double target) noexcept {
  return target >= 0 ? std::clamp(force, 0.0, target) : std::clamp(force, target, 0.0);
}

}  // namespace

ForceGate::ForceGate(const ForceGateConfig& config) noexcept : config_{config} {
  PALP_CHECK(config.force_max >= 0 && config.force_continuous > 0 && config.thermal_time > 0 &&
                 config.fade_slew > 0,
             "the limits of a gate are positive");
}

double ForceGate::limit() const noexcept {
  if (config_.force_continuous >= config_.force_max) return config_.force_max;
  // From the peak when cold down to the continuous force when hot, where heat rises no more.
  const double room = 1 - heat_ / (config_.force_continuous * config_.force_continuous);
  return config_.force_continuous +
         (config_.force_max - config_.force_continuous) * std::clamp(room, 0.0, 1.0);
}

void ForceGate::heat_up(Duration passed) noexcept {
  const double share = std::min(1.0, seconds(passed) / config_.thermal_time);
  heat_ += share * (force_ * force_ - heat_);
}

ForceAnswer ForceGate::pass(const ForceRequest& asked, const Lapse& lapse) noexcept {
  heat_up(lapse.passed());
  guard_left_ = std::max(Duration{0}, guard_left_ - lapse.passed());
  fading_ = fading_ || lapse.late();
  if (asked.state != state_ || asked.pedal_held != pedal_held_) {
    fading_ = true;
    guard_left_ = config_.fade_guard;
  }
  state_ = asked.state;
  pedal_held_ = asked.pedal_held;

  const bool finite = std::isfinite(asked.force);
  const double wanted = finite ? asked.force : 0;
  const double largest = limit();
  const bool open = asked.pedal_held && may_carry_force(asked.state);
  const double target = open ? std::clamp(wanted, -largest, largest) : 0;
  if (asked.cut || !finite) {
    force_ = 0;
    fading_ = true;
  } else if (fading_ || guard_left_ > Duration{0}) {
    const double step = config_.fade_slew * seconds(lapse.period);
    // Through an open gate only growing forces are faded in: holding one up that the law lets go of
    // would give the hand energy behind the law's back.
    const double from =
        open ? nearer_to_zero(force_, target) : std::min(force_, finite_or(asked.fade_max, force_));
    force_ = step_towards(from, target, step);
    fading_ = force_ != target;
  } else {
    force_ = target;
  }

  ForceAnswer answer{force_, !finite || force_ != asked.force, record::NoteCode::None, 0};
  const bool clamped = open && finite && target != wanted;
  if (!finite && !not_finite_) {
    answer.note = record::NoteCode::NotFinite;
  } else if (clamped && !clamped_) {
    answer.note = record::NoteCode::ForceGateClamped;
    answer.detail = asked.force;
  }
  not_finite_ = !finite;
  clamped_ = clamped;
  return answer;
}

}  // namespace palp::surgeon
