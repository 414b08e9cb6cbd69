#include "patient_site/patient_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::patient {
namespace {

using record::NoteCode;

MotionGateConfig within_devices(MotionGateConfig gate, const PatientDevices& devices) noexcept {
  const StageFacts& stage = devices.stage;
  gate.travel_min = std::max(gate.travel_min, stage.travel_min);
  gate.travel_max = std::min(gate.travel_max, stage.travel_max);
  gate.plane.travel_x = std::min(gate.plane.travel_x, 2 * stage.travel_side);
  gate.plane.travel_y = std::min(gate.plane.travel_y, 2 * stage.travel_side);
  gate.plane.speed_max = std::min(gate.plane.speed_max, stage.speed);
  gate.plane.drag_speed = stage.drags ? std::min(gate.plane.drag_speed, stage.speed) : 0;
  gate.plane.acceleration_max = std::min(gate.plane.acceleration_max, stage.acceleration);
  gate.speed_max = std::min(gate.speed_max, stage.speed);
  gate.speed_near = std::min(gate.speed_near, stage.speed);
  gate.speed_resync = std::min(gate.speed_resync, stage.speed);
  gate.retreat_speed = std::min(gate.retreat_speed, stage.speed / 3);  // it triples
  gate.retract_speed = std::min(gate.retract_speed, stage.speed);
  gate.acceleration_max = std::min(gate.acceleration_max, stage.acceleration);
  gate.contact_force = std::max(gate.contact_force, felt_as_contact(devices.sensor));
  return gate;
}

/// A reading that rests on one of the sensor's steps is not stuck: soft tissue takes some way to
/// the next.
DeviceWatchConfig allowing_for(DeviceWatchConfig watch, const ForceSensorFacts& sensor) noexcept {
  constexpr double kSoftTissue = 40;  // [N/m], less than the paper's where it is barely touched
  watch.sensor_travel = std::max(watch.sensor_travel, sensor.step / kSoftTissue);
  watch.contact_force = std::max(watch.contact_force, felt_as_contact(sensor));
  return watch;
}

}  // namespace

PatientControl::PatientControl(const PatientConfig& config,
                               const PatientDevices& devices,
                               Parts parts) noexcept
    : config_{config},
      devices_{devices},
      parts_{parts},
      gate_{within_devices(config.gate, devices), devices, seconds(config.period)},
      watch_{allowing_for(config.watch, devices.sensor)},
      account_{{config.period, config.link_status_every}, parts.recorder} {}

void PatientControl::note_not_finite(bool finite, bool& was_finite) noexcept {
  if (!finite && was_finite) account_.note(NoteCode::NotFinite);
  was_finite = finite;
  find_fault(!finite, NoteCode::DeviceFault);
}

void PatientControl::find_fault(bool found, NoteCode what) noexcept {
  if (found && device_fault_ == NoteCode::None) device_fault_ = what;
}

/// A device that gives no numbers is broken: the last good ones stay, and the site stops.
void PatientControl::take_stage(const StageState& read) noexcept {
  const bool finite =
      std::isfinite(read.position) && std::isfinite(read.velocity) && is_finite(read.place);
  note_not_finite(finite, stage_was_finite_);
  find_fault(read.faulted, NoteCode::DeviceFault);
  now_.velocity = 0;
  if (!begun_) stage_sampled_at_ = now_.at;
  if (!finite) return;
  stage_position_ = read.position;
  now_.velocity = read.velocity;
  now_.place = read.place;
  stage_sampled_at_ = read.sampled_at;
}

void PatientControl::take_force(const std::optional<ForceSample>& read) noexcept {
  if (!begun_) force_sampled_at_ = now_.at;
  if (read) {
    const bool finite = std::isfinite(read->force);
    note_not_finite(finite, force_was_finite_);
    find_fault(read->saturated, NoteCode::SensorSaturated);
    if (finite) {
      now_.contact_force = read->force;
      force_sampled_at_ = std::max(force_sampled_at_, read->sampled_at);
    }
  }
  // What the site slept through was no silence of the sensor's.
  const TimePoint heard_at = std::max(force_sampled_at_, awake_since_);
  find_fault(now_.at - heard_at > config_.sensor_stale, NoteCode::SensorSilent);
}

/// What yields between encoder and tissue is known here and in stage_target(): all else of the
/// site, and the other site, mean the tip. Its speed stays the stage's: a reading's rate is noise.
void PatientControl::find_tip() noexcept {
  now_.position = stage_position_;
  if (devices_.sensor.yield > 0) now_.position -= devices_.sensor.yield * now_.contact_force;
  if (stage_was_finite_ && !std::exchange(gate_begun_, true)) {
    gate_.begin(now_.position, now_.place);
  }
}

/// Else the tip would stop short of what the gate let pass. This feeds the force back, by less than
/// it takes for any tissue; a yield stated too large may add what the limit of force bounds.
double PatientControl::stage_target(double tip) const noexcept {
  const double force = std::clamp(now_.contact_force, 0.0, config_.gate.force_limit);
  return std::max(tip, std::min(tip + devices_.sensor.yield * force, devices_.stage.travel_max));
}

/// The state is that of the tick before, and so the target.
void PatientControl::watch_devices(const Lapse& lapse) noexcept {
  if (!begun_ || !gate_begun_) return;
  const DeviceWatch::Stuck stuck = watch_.judge({.tip = now_.position,
                                                 .target = now_.command,
                                                 .force = now_.contact_force,
                                                 .at = now_.at,
                                                 .felt_at = force_sampled_at_,
                                                 .in_tissue = gate_.inside(now_.position),
                                                 .follows = now_.state == SiteState::Engaged},
                                                lapse);
  find_fault(stuck.sensor, NoteCode::SensorStuck);
  find_fault(stuck.stage || gate_.too_deep(now_.position), NoteCode::StageStuck);
}

SupervisorOutput PatientControl::supervise(const PatientInputs& given,
                                           const Lapse& lapse) noexcept {
  SupervisorInput in;
  in.link = given.link.state;
  in.session_id = given.link.session_id;
  in.peer = given.arrived.peer;
  in.peer_heard = given.arrived.peer_heard;
  in.emergency_stop = given.user.emergency_stop;
  in.device_fault = device_fault_;
  in.overslept = lapse.passed() > kLateMax;
  // No tissue pulls like that: the sensor's sign is wrong, or something holds the tip.
  in.force_exceeded = now_.contact_force > config_.gate.force_stop ||
                      now_.contact_force < -config_.gate.force_limit;
  in.local_reset = given.user.resets != resets_;
  in.free_to_follow = gate_.free_to_follow(now_.position);
  in.retracted = gate_.retracted(now_.position);
  in.contact_force = now_.contact_force;
  resets_ = given.user.resets;
  return supervisor_.step(in);
}

void PatientControl::record_decision(const SupervisorOutput& decision, SiteState before) noexcept {
  now_.state = decision.state;
  now_.epoch = decision.epoch;
  if (decision.session_began) account_.note(NoteCode::SessionBegan);
  if (decision.reason != NoteCode::None) now_.reason = decision.reason;
  account_.transition(before, decision.state, decision.reason);
  if (decision.engaged_now) now_.refused = NoteCode::None;
  if (decision.refused != NoteCode::None) {
    now_.refused = decision.refused;
    account_.note(decision.refused, decision.detail);
  }
}

/// Samples may cause motion in Engaged only: in every other state the law does not see them.
coupling::PatientInput PatientControl::law_input(const link::Arrivals& arrived) const noexcept {
  coupling::PatientInput in;
  in.now = now_.at;
  in.state = now_.state;
  in.position = now_.position;
  in.velocity = now_.velocity;
  in.contact_force = now_.contact_force;
  in.position_age = elapsed(stage_sampled_at_, now_.at);
  in.force_age = elapsed(force_sampled_at_, now_.at);
  in.place = now_.place;
  if (now_.state == SiteState::Engaged) in.arrived = arrived.samples;
  in.round_trip = now_.link.round_trip;
  return in;
}

MotionAnswer PatientControl::limit(const coupling::PatientOutput& wanted,
                                   const Place& place,
                                   const Lapse& lapse) noexcept {
  const MotionAnswer answer = gate_.pass({.state = now_.state,
                                          .position = wanted.target_position,
                                          .place = place,
                                          .tip = now_.position,
                                          .contact_force = now_.contact_force,
                                          .stands = now_.place,
                                          .force_most = wanted.force_most},
                                         lapse);
  if (answer.note != NoteCode::None) account_.note(answer.note, answer.detail);
  if (answer.place_note != NoteCode::None) {
    account_.note(answer.place_note, is_finite(place) ? distance(place, answer.place) : 0);
  }
  now_.place_refused = answer.place_refused;
  now_.command = answer.position;
  now_.gate_acted = answer.acted;
  now_.surface_known = gate_.surface().has_value();
  now_.surface = gate_.surface().value_or(0);
  return answer;
}

PatientOutputs PatientControl::decide(const PatientInputs& in) noexcept {
  const Lapse lapse = account_.begin_tick(in.now);
  now_.at = in.now;
  if (lapse.passed() > kLateMax) awake_since_ = in.now;
  device_fault_ = NoteCode::None;
  take_stage(in.stage);
  take_force(in.force);
  find_tip();
  const bool felt = in.force && std::isfinite(in.force->force);
  gate_.feel(now_.position,
             now_.contact_force,
             felt ? std::optional{seconds(now_.at - force_sampled_at_)} : std::nullopt);
  watch_devices(lapse);
  begun_ = true;

  session_began_ = in.link.session_id != now_.link.session_id;
  if (session_began_) now_.peer_devices = in.peer_devices;
  if (session_began_ && in.link.session_id != 0) found_before_ = in.found.depth.number;
  now_.link = in.link;
  now_.peer_heard = in.arrived.peer_heard;
  now_.peer_state = in.arrived.peer.state;
  account_.arrived(in.arrived);

  const SiteState before = now_.state;
  const SupervisorOutput decision = supervise(in, lapse);
  record_decision(decision, before);
  if (decision.engaged_now) coupling::begin_epoch(parts_.law, gate_.command());
  if (decision.engaged_now || decision.resumed_now) gate_.resynchronise();

  const coupling::PatientOutput wanted = coupling::step(parts_.law, law_input(in.arrived), lapse);
  const bool place_asked = in.arrived.peer_heard && now_.state == SiteState::Engaged;
  const MotionAnswer answer =
      limit(wanted, place_asked ? in.arrived.peer.place : gate_.place(), lapse);
  take_findings(in.found);
  return {.halt = answer.halt,
          .target = {stage_target(answer.position), answer.place},
          .to_peer = {{.state = now_.state,
                       .epoch = now_.epoch,
                       .place = now_.place,
                       .depth = depth_report(),
                       .map = map_report(),
                       .map_cell = map_cell(in.map_cells)},
                      account_.within_limits(wanted.to_surgeon)}};
}

void PatientControl::write_down(const PatientInputs& in, const PatientOutputs& out) noexcept {
  if (now_.state == SiteState::Engaged) give_contact_sample();
  account_.record(SiteTick{.at = now_.at,
                           .state = now_.state,
                           .epoch = now_.epoch,
                           .position = now_.position,
                           .velocity = now_.velocity,
                           .force = now_.contact_force,
                           .place = now_.place,
                           .command = now_.command,
                           .gate_acted = now_.gate_acted,
                           .round_trip = now_.link.round_trip,
                           .sent = out.to_peer.port});
  account_.link(in.link);
  record_readings(in);
  static_cast<record::SiteCounts&>(now_) = account_.counts();
}

/// The inputs, so that they can be given again.
void PatientControl::record_readings(const PatientInputs& in) noexcept {
  account_.devices({.hand = {}, .stage = devices_.stage, .sensor = devices_.sensor},
                   in.peer_devices,
                   session_began_);
  account_.user(in.user);
  account_.record(StageReading{.at = in.now,
                               .age = elapsed(in.stage.sampled_at, in.now),
                               .position = in.stage.position,
                               .velocity = in.stage.velocity,
                               .place = in.stage.place,
                               .at_limit = in.stage.at_limit,
                               .faulted = in.stage.faulted});
  const ForceSample force = in.force.value_or(ForceSample{.sampled_at = in.now});
  account_.record(ForceReading{.at = in.now,
                               .fresh = in.force.has_value(),
                               .age = elapsed(force.sampled_at, in.now),
                               .force = force.force,
                               .saturated = force.saturated});
  account_.heard(in.link, in.arrived, in.found.depth.number);
}

void PatientControl::give_contact_sample() noexcept {
  const bool taken =
      parts_.contact.try_enqueue({.at = now_.at,
                                  .position = now_.position,
                                  .force = now_.contact_force,
                                  .place = now_.place,
                                  .position_age = elapsed(stage_sampled_at_, now_.at),
                                  .force_age = elapsed(force_sampled_at_, now_.at),
                                  .session = now_.link.session_id});
  ++(taken ? now_.contact_samples : now_.contact_samples_lost);
}

/// What was found in an earlier session is no answer in this one.
void PatientControl::take_findings(const Findings& found) noexcept {
  now_.depth = found.depth.number > found_before_ ? found.depth : DepthEstimate{};
  now_.map = found.map.number > found_before_ ? found.map : MapReport{};
}

DepthReport PatientControl::depth_report() const noexcept {
  return {.number = now_.depth.number,
          .verdict = now_.depth.verdict,
          .reason = now_.depth.reason,
          .depth = now_.depth.depth,
          .depth_stddev = now_.depth.depth_stddev,
          .depth_low = now_.depth.depth_low,
          .depth_high = now_.depth.depth_high,
          .hash = now_.depth.hash,
          .place = now_.depth.place};
}

/// It is long and changes once a stroke: some telegrams say it, and one of them will arrive.
MapReport PatientControl::map_report() const noexcept {
  constexpr std::uint64_t kTicksApart = 20;
  return account_.counts().ticks % kTicksApart == 0 ? now_.map : MapReport{};
}

/// By turns, for ever: what is lost comes again with the next round, 0.7 s later. Never in a
/// telegram that has the map.
MapCell PatientControl::map_cell(std::span<const MapCell> cells) const noexcept {
  constexpr std::uint64_t kTicksApart = 4;
  constexpr std::uint64_t kAfterMap = 2;
  const std::uint64_t ticks = account_.counts().ticks;
  if (cells.empty() || ticks % kTicksApart != kAfterMap) return {};
  const MapCell& cell = cells[ticks / kTicksApart % cells.size()];
  return cell.number == now_.map.number ? cell : MapCell{};
}

}  // namespace palp::patient
