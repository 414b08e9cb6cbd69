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

}  // namespace

ForceGate::ForceGate(const ForceGateConfig& config) noexcept
    : config_{config}, growth_{config.growth} {
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
  growth_.move(finite_or(asked.way, 0), finite_or(asked.velocity, 0), lapse);

  const bool finite = std::isfinite(asked.force);
  const double wanted = finite ? asked.force : 0;
  const double largest = limit();
  const bool open = asked.pedal_held && may_carry_force(asked.state);
  const double target = open ? std::clamp(wanted, -largest, largest) : 0;
  if (asked.cut || !finite) {
    force_ = 0;
  } else if (open) {
    // Holding a force up that the law lets go of would give the hand energy behind the law's back.
    force_ = growth_.follow(force_, target);
  } else {
    growth_.forget();
    const double payable = std::min(force_, finite_or(asked.fade_max, force_));
    force_ = step_towards(payable, 0, config_.fade_slew * seconds(lapse.period));
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
