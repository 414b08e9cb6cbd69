#include "surgeon_site/surgeon_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/check.h"

namespace palp::surgeon {
namespace {

using record::NoteCode;

/// What a law may do in one tick is bounded by time; what the process slept through buys nothing.
constexpr Duration kLawTickMax = std::chrono::milliseconds{10};

/// The hand presses, and does not only move air: two steps of the patient's transducer.
constexpr double kPressed = 0.1;  // [N]

ForceGateConfig within_device(ForceGateConfig gate, const HapticDevice& device) {
  gate.force_max = std::min(gate.force_max, device.force_max());
  gate.force_continuous = std::min(gate.force_continuous, device.force_continuous());
  return gate;
}

bool finite(const HandState& hand) noexcept {
  return std::isfinite(hand.position) && std::isfinite(hand.velocity) && is_finite(hand.place);
}

}  // namespace

SurgeonNode::SurgeonNode(const SurgeonConfig& config, Parts parts)
    : config_{config},
      parts_{parts},
      supervisor_{config.supervisor},
      gate_{within_device(config.gate, parts.device)} {
  PALP_CHECK(config.period > Duration{0}, "a period takes time");
}

/// A whole number of periods, so that a law's filters keep their step.
Duration SurgeonNode::time_passed(TimePoint now) noexcept {
  std::int64_t periods = 1;
  if (begun_) {
    periods = std::max<std::int64_t>(1, (now - now_.at + config_.period / 2) / config_.period);
  }
  begun_ = true;
  now_.at = now;
  ++now_.ticks;
  now_.ticks_missed += static_cast<std::uint64_t>(periods - 1);
  return periods * config_.period;
}

/// A device that gives no numbers is broken: the last good ones stay, and the site stops.
HandState SurgeonNode::read_hand(TimePoint now) noexcept {
  const HandState read = parts_.device.read(now);
  const bool is_finite = finite(read);
  if (!is_finite && hand_was_finite_) note(NoteCode::NotFinite);
  hand_was_finite_ = is_finite;
  if (is_finite) {
    hand_ = read;
  } else {
    hand_.velocity = 0;
    hand_.faulted = true;
  }
  return hand_;
}

/// What an earlier session said of the tip is no place to align with.
void SurgeonNode::forget_peer() noexcept {
  now_.tip_known = false;
  now_.contact_force = 0;
  now_.depth = {};
}

void SurgeonNode::hear(const link::Arrivals& arrived) noexcept {
  now_.peer_heard = arrived.peer_heard;
  now_.peer_state = arrived.peer.state;
  for (const Incoming& incoming : arrived.samples) record(Arrived{now_.at, incoming});
  if (const Incoming* last = coupling::newest(arrived.samples)) {
    now_.tip = last->sample.position;
    now_.contact_force = last->sample.force;
    now_.tip_known = true;
  }
  if (arrived.peer_heard && arrived.peer.depth.number != now_.depth.number) {
    now_.depth = arrived.peer.depth;
    if (now_.depth.number != 0) record(DepthArrived{now_.at, now_.depth});
  }
}

SupervisorOutput SurgeonNode::supervise(const HandState& hand,
                                        const link::Arrivals& arrived) noexcept {
  const UserCommand& command = commands_.get();
  SupervisorInput in;
  in.now = now_.at;
  in.pedal_held = hand.pedal_held;
  in.emergency_stop = hand.emergency_stop || command.emergency_stop;
  in.device_faulted = hand.faulted;
  in.local_reset = command.resets != resets_;
  in.link = now_.link.state;
  in.session_id = now_.link.session_id;
  in.gap = now_.link.gap;
  in.round_trip = now_.link.round_trip;
  in.peer = arrived.peer;
  in.peer_heard = arrived.peer_heard;
  in.tip_known = now_.tip_known;
  resets_ = command.resets;
  return supervisor_.step(in);
}

/// From here on hand and tip move together; whatever lay between them is the clutch's.
void SurgeonNode::engage(const HandState& hand) noexcept {
  now_.offset = hand.position - now_.tip;
  now_.refused = NoteCode::None;
  coupling::begin_epoch(parts_.law, hand.position - now_.offset);
}

void SurgeonNode::tick(TimePoint now) noexcept {
  const Duration dt = time_passed(now);
  const HandState hand = read_hand(now);
  const link::Arrivals arrived = parts_.link.receive(now);
  const std::uint64_t session_before = std::exchange(now_.link, parts_.link.health(now)).session_id;
  if (now_.link.session_id != session_before) forget_peer();
  hear(arrived);

  const SiteState before = now_.state;
  const SupervisorOutput decision = supervise(hand, arrived);
  record_decision(decision, before);
  if (decision.engaged_now) engage(hand);

  coupling::SurgeonInput in;
  in.now = now;
  in.state = decision.state;
  in.position = hand.position - now_.offset;
  in.velocity = hand.velocity;
  in.force_applied = now_.force;
  in.round_trip = now_.link.round_trip;
  if (decision.state == SiteState::Engaged && !decision.engaged_now) in.arrived = arrived.samples;
  const coupling::SurgeonOutput out =
      coupling::step(parts_.law, in, std::min(dt, std::max(kLawTickMax, config_.period)));

  const bool cut = hand.faulted || hand.emergency_stop || commands_.get().emergency_stop;
  const ForceAnswer answer =
      gate_.pass({out.force, decision.state, hand.pedal_held, cut, out.fade_max}, dt);
  parts_.device.apply(answer.force);
  parts_.device.hold_in_plane(config_.hold_in_plane && answer.force >= kPressed);
  parts_.link.send({{decision.state, decision.epoch, hand.place, {}}, out.to_patient}, now);

  if (answer.note != NoteCode::None) note(answer.note, answer.detail);
  record(SiteTick{.at = now,
                  .state = decision.state,
                  .epoch = decision.epoch,
                  .position = in.position,
                  .velocity = in.velocity,
                  .force = in.force_applied,
                  .place = hand.place,
                  .command = answer.force,
                  .gate_acted = answer.acted,
                  .round_trip = in.round_trip,
                  .sent = out.to_patient});
  record_link(now);
  parts_.device.show({decision.state, now_.peer_state, now_.link.state, now_.tip, now_.tip_known});
  record_script();

  now_.position = in.position;
  now_.place = hand.place;
  now_.force = answer.force;
  now_.gate_acted = answer.acted;
  status_.put(now_);
}

void SurgeonNode::record_decision(const SupervisorOutput& decision, SiteState before) noexcept {
  now_.state = decision.state;
  now_.epoch = decision.epoch;
  if (decision.session_began) note(NoteCode::SessionBegan);
  if (decision.reason != NoteCode::None) {
    now_.reason = decision.reason;
    const auto reason = static_cast<std::uint16_t>(decision.reason);
    record(Transition{now_.at, before, decision.state, reason});
  }
  if (decision.refused != NoteCode::None) {
    now_.refused = decision.refused;
    note(decision.refused, decision.detail);
  }
}

void SurgeonNode::record_script() noexcept {
  now_.script = parts_.device.progress();
  if (!now_.script.begun || now_.script.phase == script_phase_) return;
  script_phase_ = now_.script.phase;
  note(NoteCode::ScriptPhase, script_phase_);
}

void SurgeonNode::record_link(TimePoint now) noexcept {
  link_events_.look(now_.link, [this](NoteCode code, double detail) { note(code, detail); });
  if (link_recorded_at_ && now - *link_recorded_at_ < config_.link_status_every) return;
  link_recorded_at_ = now;
  record(LinkStatus{now, now_.link});
}

void SurgeonNode::note(NoteCode code, double detail) noexcept {
  record(Note{now_.at, static_cast<std::uint16_t>(code), detail});
}

void SurgeonNode::record(const Record& record) noexcept {
  if (parts_.recorder.record(record)) {
    ++now_.records;
  } else {
    ++now_.records_lost;
  }
}

}  // namespace palp::surgeon
