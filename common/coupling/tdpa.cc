#include "common/coupling/tdpa.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kStill = 1e-4;  // [m/s], a slower port dissipates nothing

/// The newest sum that arrived: late, lost or repeated samples can only make it too small.
void take_largest(double& known, std::span<const Incoming> arrived) noexcept {
  for (const Incoming& incoming : arrived) {
    const auto* payload = std::get_if<TdpaPayload>(&incoming.sample.payload);
    if (payload != nullptr && std::isfinite(payload->energy_in)) {
      known = std::max(known, payload->energy_in);
    }
  }
}

}  // namespace

TdpaSurgeon::TdpaSurgeon(const TdpaConfig& config) noexcept
    : config_{config}, velocity_{config.velocity_cut_off, config.period} {}

void TdpaSurgeon::begin_epoch(double position) noexcept {
  velocity_.reset();
  position_before_ = position;
  energy_in_ = energy_out_ = energy_remote_ = 0;
  tip_force_ = force_ = 0;
  heard_ = false;
  fade_.set(1);
}

void TdpaSurgeon::hear(std::span<const Incoming> arrived) noexcept {
  take_largest(energy_remote_, arrived);
  if (const Incoming* last = newest(arrived)) {
    tip_force_ = std::max(0.0, last->sample.force);
    heard_ = true;
  }
}

/// What is dissipated here pays for what came out too much, or the controller would never stop.
void TdpaSurgeon::account(double work) noexcept {
  if (work <= 0) {
    energy_out_ -= work;
    return;
  }
  const double debt = std::max(0.0, energy_out_ - energy_remote_);
  const double pay = std::min(work, debt);
  energy_out_ -= pay;
  energy_in_ += work - pay;
}

/// The tip's force, of which on the way out only so much comes back as has been paid for.
double TdpaSurgeon::passive_force(double speed) const noexcept {
  const double budget = energy_remote_ - energy_out_;
  const double outwards = std::clamp(-speed / config_.direction_speed, 0.0, 1.0);
  const double share = std::clamp(budget / config_.energy_soft, 0.0, 1.0);
  double force = tip_force_ * (1 - outwards * (1 - share)) + config_.damping * speed;
  if (budget < 0 && std::abs(speed) > kStill) {
    const double needed = -budget / (config_.period * speed * speed);
    force += std::min(needed, config_.damping_max) * speed;
  }
  return force;
}

SurgeonOutput TdpaSurgeon::step(const SurgeonInput& in, Duration dt) noexcept {
  hear(in.arrived);
  const double speed = velocity_.step(in.position);
  account(in.force_applied * (in.position - position_before_));
  position_before_ = in.position;
  if (in.state == SiteState::Engaged) {
    fade_.rise(seconds(dt), config_.fade_in);
  } else {
    fade_.fall(seconds(dt), config_.fade_out);
  }
  const double wanted = heard_ ? fade_.value() * passive_force(speed) : 0;
  force_ = step_towards(force_, wanted, config_.slew * seconds(dt));
  return {force_, {in.position, in.velocity, force_, TdpaPayload{energy_in_}}};
}

TdpaPatient::TdpaPatient(const TdpaConfig& config) noexcept
    : config_{config}, tip_{config.sensor_cut_off, config.period} {}

void TdpaPatient::begin_epoch(double position) noexcept {
  energy_in_ = energy_out_ = energy_remote_ = 0;
  hand_ = hand_taken_ = target_ = position;
}

void TdpaPatient::hear(std::span<const Incoming> arrived) noexcept {
  take_largest(energy_remote_, arrived);
  if (const Incoming* last = newest(arrived)) hand_ = last->sample.position;
}

void TdpaPatient::account(double work) noexcept {
  if (work > 0) {
    energy_out_ += work;
    return;
  }
  const double debt = std::max(0.0, energy_out_ - energy_remote_);
  const double pay = std::min(-work, debt);
  energy_out_ -= pay;
  energy_in_ += -work - pay;
}

PatientOutput TdpaPatient::step(const PatientInput& in, Duration /*dt*/) noexcept {
  if (!started_) tip_.reset(in.position);
  const double before = started_ ? tip_.value() : in.position;
  started_ = true;
  tip_.step(in.position);
  hear(in.arrived);
  const double force = std::max(0.0, in.contact_force);
  account(force * (tip_.value() - before));
  if (in.state != SiteState::Engaged) {
    target_ = in.position;
    return {target_, {in.position, in.velocity, in.contact_force, TdpaPayload{energy_in_}}};
  }
  const double step = hand_ - hand_taken_;
  hand_taken_ = hand_;
  const double lag = hand_taken_ - target_ - step;
  const double step_max = config_.speed_max * config_.period;
  double move = std::clamp(step + config_.drift_rate * config_.period * lag, -step_max, step_max);
  if (move > 0 && force > 0) {
    const double budget = energy_remote_ - energy_out_;
    const double committed = force * std::max(0.0, target_ - tip_.value());
    move = std::min(move, std::max(0.0, budget - committed) / force);
    if (budget < 0) move -= std::min(0.02 * config_.period, -0.05 * budget / force);
  }
  target_ += move;
  return {target_, {in.position, in.velocity, in.contact_force, TdpaPayload{energy_in_}}};
}

}  // namespace palp::coupling
