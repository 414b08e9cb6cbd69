#include "patient_site/patient_node.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"

namespace palp::patient {

using record::NoteCode;

PatientNode::PatientNode(const PatientConfig& config, Parts parts)
    : config_{config},
      parts_{parts},
      gate_{config.gate},
      watch_{config.watch},
      co_filter_{config.sensor_cut_off, seconds(config.period)} {
  PALP_CHECK(config.period > Duration{0}, "a period takes time");
}

/// A whole number of periods, so that a law's filters keep their step.
Duration PatientNode::time_passed(TimePoint now) noexcept {
  std::int64_t periods = 1;
  if (begun_) {
    periods = std::max<std::int64_t>(1, (now - now_.at + config_.period / 2) / config_.period);
  }
  now_.at = now;
  ++now_.ticks;
  now_.ticks_missed += static_cast<std::uint64_t>(periods - 1);
  return periods * config_.period;
}

void PatientNode::note_not_finite(bool finite, bool& was_finite) noexcept {
  if (!finite && was_finite) note(NoteCode::NotFinite);
  was_finite = finite;
  if (!finite) device_faulted_ = true;
}

/// A device that gives no numbers is broken: the last good ones stay, and the site stops.
void PatientNode::read_stage() noexcept {
  const StageState read = parts_.stage.read(now_.at);
  const bool finite =
      std::isfinite(read.position) && std::isfinite(read.velocity) && is_finite(read.place);
  note_not_finite(finite, stage_was_finite_);
  device_faulted_ = device_faulted_ || read.faulted;
  now_.velocity = 0;
  if (!finite) return;
  now_.position = read.position;
  now_.velocity = read.velocity;
  now_.place = read.place;
  if (!begun_) {
    co_filter_.reset(read.position);
    gate_.begin(read.position, read.place, parts_.stage.can_drag());
  }
}

void PatientNode::read_force() noexcept {
  if (!begun_) force_sampled_at_ = now_.at;
  if (const std::optional<ForceSample> read = parts_.sensor.sample(now_.at)) {
    const bool finite = std::isfinite(read->force);
    note_not_finite(finite, force_was_finite_);
    device_faulted_ = device_faulted_ || read->saturated;
    if (finite) {
      now_.contact_force = read->force;
      force_sampled_at_ = std::max(force_sampled_at_, read->sampled_at);
    }
  }
  if (now_.at - force_sampled_at_ > config_.sensor_stale) device_faulted_ = true;
}

/// Only while the tip has somewhere to go: the state is that of the tick before, and so the target.
void PatientNode::watch_devices(Duration dt) noexcept {
  if (now_.state != SiteState::Engaged) {
    watch_.reset();
    return;
  }
  const bool stuck = watch_.stuck({.tip = now_.position,
                                   .target = now_.command,
                                   .force = now_.contact_force,
                                   .in_tissue = gate_.inside(now_.position)},
                                  dt);
  device_faulted_ = device_faulted_ || stuck;
}

SupervisorOutput PatientNode::supervise(const link::Arrivals& arrived) noexcept {
  const UserCommand& command = commands_.get();
  SupervisorInput in;
  in.link = now_.link.state;
  in.session_id = now_.link.session_id;
  in.peer = arrived.peer;
  in.peer_heard = arrived.peer_heard;
  in.emergency_stop = command.emergency_stop;
  in.device_faulted = device_faulted_;
  in.force_exceeded = now_.contact_force > config_.gate.force_stop;
  in.local_reset = command.resets != resets_;
  in.free_to_follow = gate_.free_to_follow(now_.position);
  in.retracted = gate_.retracted(now_.position);
  in.contact_force = now_.contact_force;
  resets_ = command.resets;
  return supervisor_.step(in);
}

void PatientNode::record_decision(const SupervisorOutput& decision, SiteState before) noexcept {
  now_.state = decision.state;
  now_.epoch = decision.epoch;
  if (decision.session_began) note(NoteCode::SessionBegan);
  if (decision.reason != NoteCode::None) {
    now_.reason = decision.reason;
    const auto reason = static_cast<std::uint16_t>(decision.reason);
    record(Transition{now_.at, before, decision.state, reason});
  }
  if (decision.engaged_now) now_.refused = NoteCode::None;
  if (decision.refused != NoteCode::None) {
    now_.refused = decision.refused;
    note(decision.refused, decision.detail);
  }
}

/// Samples may cause motion in Engaged only: in every other state the law does not see them.
coupling::PatientInput PatientNode::law_input(const link::Arrivals& arrived) const noexcept {
  coupling::PatientInput in;
  in.now = now_.at;
  in.state = now_.state;
  in.position = now_.position;
  in.velocity = now_.velocity;
  in.contact_force = now_.contact_force;
  in.place = now_.place;
  if (now_.state == SiteState::Engaged) in.arrived = arrived.samples;
  in.round_trip = now_.link.round_trip;
  return in;
}

MotionAnswer PatientNode::move(double target, const Place& place, Duration dt) noexcept {
  const MotionAnswer answer = gate_.pass({.state = now_.state,
                                          .position = target,
                                          .place = place,
                                          .tip = now_.position,
                                          .contact_force = now_.contact_force},
                                         dt);
  if (answer.halt) {
    parts_.stage.halt();
  } else {
    parts_.stage.move_to({answer.position, answer.place});
  }
  if (answer.note != NoteCode::None) note(answer.note, answer.detail);
  if (answer.place_note != NoteCode::None) note(answer.place_note, distance(place, answer.place));
  now_.place_refused = answer.place_refused;
  now_.command = answer.position;
  now_.gate_acted = answer.acted;
  now_.surface_known = gate_.surface().has_value();
  now_.surface = gate_.surface().value_or(0);
  return answer;
}

void PatientNode::tick(TimePoint now) noexcept {
  const Duration dt = time_passed(now);
  device_faulted_ = false;
  read_stage();
  read_force();
  co_filter_.step(now_.position);
  gate_.feel(co_filter_.value(), now_.contact_force);
  watch_devices(dt);
  begun_ = true;

  const link::Arrivals arrived = parts_.link.receive(now);
  now_.link = parts_.link.health(now);
  now_.peer_heard = arrived.peer_heard;
  now_.peer_state = arrived.peer.state;
  for (const Incoming& incoming : arrived.samples) record(Arrived{now, incoming});

  const SiteState before = now_.state;
  const SupervisorOutput decision = supervise(arrived);
  record_decision(decision, before);
  if (decision.engaged_now) coupling::begin_epoch(parts_.law, gate_.command());
  if (decision.engaged_now || decision.resumed_now) gate_.resynchronise();

  const coupling::PatientInput in = law_input(arrived);
  const coupling::PatientOutput out = coupling::step(parts_.law, in, dt);
  const bool place_asked = arrived.peer_heard && now_.state == SiteState::Engaged;
  const MotionAnswer answer =
      move(out.target_position, place_asked ? arrived.peer.place : gate_.place(), dt);
  parts_.link.send({{now_.state, now_.epoch, now_.place, depth_report()}, out.to_surgeon}, now);

  if (now_.state == SiteState::Engaged) give_contact_sample();
  record(SiteTick{.at = now,
                  .state = now_.state,
                  .epoch = now_.epoch,
                  .position = in.position,
                  .velocity = in.velocity,
                  .force = in.contact_force,
                  .place = in.place,
                  .command = answer.position,
                  .gate_acted = answer.acted,
                  .round_trip = in.round_trip,
                  .sent = out.to_surgeon});
  record_link();
  status_.put(now_);
}

void PatientNode::give_contact_sample() noexcept {
  const bool taken = parts_.contact.try_enqueue({.at = now_.at,
                                                 .position = co_filter_.value(),
                                                 .force = now_.contact_force,
                                                 .place = now_.place});
  ++(taken ? now_.contact_samples : now_.contact_samples_lost);
}

DepthReport PatientNode::depth_report() noexcept {
  now_.depth = parts_.depth.get();
  return {.number = now_.depth.number,
          .verdict = now_.depth.verdict,
          .reason = now_.depth.reason,
          .depth = now_.depth.depth,
          .depth_stddev = now_.depth.depth_stddev,
          .depth_low = now_.depth.depth_low,
          .depth_high = now_.depth.depth_high,
          .hash = now_.depth.hash};
}

void PatientNode::record_link() noexcept {
  link_events_.look(now_.link, [this](NoteCode code, double detail) { note(code, detail); });
  if (link_recorded_at_ && now_.at - *link_recorded_at_ < config_.link_status_every) return;
  link_recorded_at_ = now_.at;
  record(LinkStatus{now_.at, now_.link});
}

void PatientNode::note(NoteCode code, double detail) noexcept {
  record(Note{now_.at, static_cast<std::uint16_t>(code), detail});
}

void PatientNode::record(const Record& record) noexcept {
  if (parts_.recorder.record(record)) {
    ++now_.records;
  } else {
    ++now_.records_lost;
  }
}

}  // namespace palp::patient
