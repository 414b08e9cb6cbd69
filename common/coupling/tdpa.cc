#include "common/coupling/tdpa.h"

#include <algorithm>
#include <cmath>

namespace palp::coupling {
namespace {

constexpr double kLow = 0.5;
constexpr double kTouchForce = 0.1;     // [N], two steps of the transducer
constexpr double kNoForce = 0.025;      // [N], a mean force below it is none
constexpr double kForceMeanGain = 0.2;  // per sample: 5 of them
constexpr double kDragShare = 0.15;     // of the slew, on top of what the spring takes of it
// [s], round trips: up to the first the law knows of no path; from the second on it is a long one.
constexpr double kNearTrip = 0.06;
constexpr double kFarTrip = 0.16;
// [s], from here on the local spring is there in full; over shorter paths, by their square, it is
// not needed, and would make taps feel too stiff.
constexpr double kLocal = 0.09;

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
    : config_{config}, velocity_{config.velocity_cut_off, config.period}, tank_{config.tank} {}

void TdpaSurgeon::begin_epoch(double position) noexcept {
  velocity_.reset();
  tank_.begin_epoch(position);
  energy_in_ = energy_out_ = energy_remote_ = 0;
  tip_force_ = calm_force_ = mean_force_ = reserve_ = pull_ = drag_ = 0;
  tip_position_ = position;
  heard_ = false;
  fade_.set(1);
}

void TdpaSurgeon::hear(std::span<const Incoming> arrived) noexcept {
  take_largest(energy_remote_, arrived);
  if (const Incoming* last = newest(arrived)) {
    tip_force_ = std::max(0.0, last->sample.force);
    tip_position_ = last->sample.position;
    mean_force_ += kForceMeanGain * (tip_force_ - mean_force_);
    heard_ = true;
  }
}

double TdpaSurgeon::stored() const noexcept { return 0.5 * pull_ * pull_ / config_.spring; }

/// The hand's way moves its end of the spring; its work pays for that and fills the reserve.
void TdpaSurgeon::account(double work, double way) noexcept {
  const double before = stored();
  pull_ = std::max(0.0, pull_ + config_.spring * way);
  reserve_ += work - (stored() - before);
}

/// The tip's force where the tip was, and the local spring from there to where the hand is.
double TdpaSurgeon::wanted_force(double position, double trip) noexcept {
  const double time = config_.calm * std::max(0.0, trip - kNearTrip);
  calm_force_ += (tip_force_ - calm_force_) * config_.period / (config_.period + time);
  const double touch = std::clamp((mean_force_ - kNoForce) / (kTouchForce - kNoForce), 0.0, 1.0);
  const double share = std::min(1.0, trip * trip / (kLocal * kLocal));
  return std::max(0.0,
                  calm_force_ + touch * share * config_.spring_local * (position - tip_position_));
}

/// Letting go of the spring gives energy back, pulling it costs. It is pulled no faster than it
/// would be by a hand that moves its reach in a round trip: one that moves away faster lets go.
void TdpaSurgeon::approach(double wanted, double trip, double passed) noexcept {
  const double remote = std::max(0.0, energy_remote_ - energy_out_);
  const double before = stored();
  const double whole = std::max(0.0, before + reserve_ + remote);
  const double pace = std::max(config_.creep, config_.reach / std::max(trip, config_.period));
  const double rise = std::min(config_.slew, config_.spring * pace) * passed;
  pull_ =
      std::min({wanted, pull_ + rise, std::sqrt(2 * config_.spring * whole), tank_.force_max()});
  reserve_ -= stored() - before;
}

/// What the reserve lacks is drawn from what entered at the other end, what it cannot hold goes on
/// to there. So does what came from there and is not needed here: kept, it would lack there, and
/// the tip could not follow the hand into the tissue.
void TdpaSurgeon::share_energy(double trip) noexcept {
  const double far = std::clamp((trip - kNearTrip) / (kFarTrip - kNearTrip), 0.0, 1.0);
  const double kept =
      std::lerp(config_.reserve, std::max(config_.reserve, config_.reserve_far), far);
  const double remote = std::max(0.0, energy_remote_ - energy_out_);
  const double drawn = std::clamp(kLow * kept - reserve_, 0.0, remote);
  energy_out_ += drawn;
  reserve_ += drawn;
  const double surplus = std::max(0.0, reserve_ - kept);
  energy_in_ += surplus;
  reserve_ -= surplus;
  const double due = std::max(0.0, 0.5 * tip_force_ * tip_force_ / config_.spring - stored());
  const double returned = std::max(0.0, remote - drawn - config_.credit - due);
  energy_out_ += returned;
  energy_in_ += returned;
}

/// More on the way back only: on the way in stiffness is judged, and damping that falls
/// with speed would be felt as softness.
double TdpaSurgeon::damping(double speed) const noexcept {
  if (speed >= 0) return config_.damping;
  const double contact = std::clamp(tip_force_ / kTouchForce, 0.0, 1.0);
  return config_.damping_back + contact * (config_.damping_out - config_.damping_back);
}

SurgeonOutput TdpaSurgeon::step(const SurgeonInput& in, const Lapse& lapse) noexcept {
  hear(in.arrived);
  const double speed = velocity_.step(in.position, lapse.periods);
  const double way = tank_.account(in.force_applied, in.position);
  const double pulled = pull_;
  account(in.force_applied * way, way);
  if (in.state == SiteState::Engaged) {
    fade_.rise(seconds(lapse.period), config_.fade_in);
  } else {
    fade_.fall(seconds(lapse.period), config_.fade_out);
  }
  const double trip = std::max(0.0, seconds(in.round_trip));
  const double change = config_.slew * seconds(lapse.period);
  const double felt = wanted_force(in.position, trip);
  const double wanted = heard_ ? fade_.value() * felt : 0;
  approach(std::max(0.0, std::clamp(wanted, pulled - change, pulled + change)),
           trip,
           config_.period * static_cast<double>(lapse.periods));
  share_energy(trip);
  // Spring and damping have one slew: what is felt is their sum.
  const double left = std::max(kDragShare * change, change - std::abs(pull_ - pulled));
  drag_ = step_towards(drag_, heard_ ? damping(speed) * speed : 0, left);
  // After a turn drag points the wrong way until the filter has followed: not at others' cost.
  if (reserve_ < 0 && drag_ * way < 0) drag_ = 0;
  const double force = pull_ + drag_;
  return {force, {in.position, in.velocity, force, TdpaPayload{energy_in_}}, std::max(0.0, force)};
}

TdpaPatient::TdpaPatient(const TdpaConfig& config, const PatientDevices& devices) noexcept
    : config_{config},
      step_max_{devices.stage.speed * config.period},
      tip_{devices.sensor.pole, config.period} {}

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

PatientOutput TdpaPatient::step(const PatientInput& in, const Lapse& lapse) noexcept {
  if (!started_) tip_.reset(in.position);
  const double before = started_ ? tip_.value() : in.position;
  started_ = true;
  tip_.step(in.position, lapse.periods);
  hear(in.arrived);
  const double force = std::max(0.0, in.contact_force);
  const double way = tip_.value() - before;
  // Nobody knows the force in between: at most the larger of both went out, and the smaller came
  // in.
  const double other = lapse.late() ? force_before_ : force;
  account((way > 0 ? std::max(force, other) : std::min(force, other)) * way);
  force_before_ = force;
  if (in.state != SiteState::Engaged) {
    target_ = in.position;
    return {target_, {in.position, in.velocity, in.contact_force, TdpaPayload{energy_in_}}};
  }
  const double step = hand_ - hand_taken_;
  hand_taken_ = hand_;
  const double lag = hand_taken_ - target_ - step;
  double move = std::clamp(step + config_.drift_rate * config_.period * lag, -step_max_, step_max_);
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
