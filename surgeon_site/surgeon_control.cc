#include "surgeon_site/surgeon_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp::surgeon {
namespace {

using record::NoteCode;

ForceGateConfig within_device(ForceGateConfig gate, const HandFacts& hand) noexcept {
  gate.force_max = std::min(gate.force_max, hand.force_peak);
  gate.force_continuous = std::min(gate.force_continuous, hand.force_continuous);
  return gate;
}

bool finite(const HandState& hand) noexcept {
  return std::isfinite(hand.position) && std::isfinite(hand.velocity) && is_finite(hand.place);
}

}  // namespace

SurgeonControl::SurgeonControl(const SurgeonConfig& config,
                               const HandFacts& hand,
                               Parts parts) noexcept
    : config_{config},
      facts_{hand},
      at_hand_{hand, seconds(config.period)},
      parts_{parts},
      supervisor_{config.supervisor},
      gate_{within_device(config.gate, hand)},
      account_{{config.period, config.link_status_every}, parts.recorder} {}

/// A device that gives no numbers is broken: the last good ones stay, and the site stops.
void SurgeonControl::take_hand(const HandState& read) noexcept {
  const bool is_finite = finite(read);
  if (!is_finite && hand_was_finite_) account_.note(NoteCode::NotFinite);
  hand_was_finite_ = is_finite;
  if (is_finite) {
    hand_ = read;
  } else {
    hand_.velocity = 0;
    hand_.faulted = true;
  }
}

/// What an earlier session said of the tip is no place to align with.
void SurgeonControl::begin_session(const DeviceFacts& peer) noexcept {
  now_.tip_known = false;
  now_.contact_force = 0;
  now_.depth = {};
  now_.map = {};
  cells_ = {};
  now_.peer_devices = peer;
  if (peer.stage && peer.sensor) coupling::meet(parts_.law, {*peer.stage, *peer.sensor});
}

void SurgeonControl::hear(const link::Arrivals& arrived) noexcept {
  now_.peer_heard = arrived.peer_heard;
  now_.peer_state = arrived.peer.state;
  if (arrived.peer_heard) now_.peer_place = arrived.peer.place;
  account_.arrived(arrived);
  if (const Incoming* last = coupling::newest(arrived.samples)) {
    now_.tip = last->sample.position;
    now_.contact_force = last->sample.force;
    now_.tip_known = true;
  }
  if (arrived.peer_heard && arrived.peer.depth.number != now_.depth.number) {
    now_.depth = arrived.peer.depth;
    if (now_.depth.number != 0) account_.record(DepthArrived{now_.at, now_.depth});
  }
  const MapReport& map = arrived.peer.map;
  if (arrived.peer_heard && map.number != 0 && !(map == now_.map)) {
    now_.map = map;
    account_.record(MapArrived{now_.at, map});
  }
  if (arrived.peer_heard) hear(arrived.peer.map_cell);
}

/// Each comes again and again; the file gets it once.
void SurgeonControl::hear(MapCell cell) noexcept {
  if (cell.number == 0 || cell.index >= kMapCellsMax) return;
  if (cell.number != cells_.number) cells_ = {cell.number, {}};
  if (cells_.indices.test(cell.index)) return;
  cells_.indices.set(cell.index);
  cell.at = now_.at;
  account_.record(cell);
}

SupervisorOutput SurgeonControl::supervise(const SurgeonInputs& given,
                                           const Lapse& lapse) noexcept {
  SupervisorInput in;
  in.now = now_.at;
  in.pedal_held = hand_.pedal_held;
  in.emergency_stop = hand_.emergency_stop || given.user.emergency_stop;
  in.device_faulted = hand_.faulted;
  in.overslept = lapse.passed() > kLateMax;
  in.local_reset = given.user.resets != resets_;
  in.link = now_.link.state;
  in.session_id = now_.link.session_id;
  in.gap = now_.link.gap;
  in.round_trip = now_.link.round_trip;
  in.peer = given.arrived.peer;
  in.peer_heard = given.arrived.peer_heard;
  in.tip_known = now_.tip_known;
  resets_ = given.user.resets;
  return supervisor_.step(in);
}

void SurgeonControl::record_decision(const SupervisorOutput& decision, SiteState before) noexcept {
  now_.state = decision.state;
  now_.epoch = decision.epoch;
  if (decision.session_began) account_.note(NoteCode::SessionBegan);
  if (decision.reason != NoteCode::None) now_.reason = decision.reason;
  account_.transition(before, decision.state, decision.reason);
  if (decision.refused != NoteCode::None) {
    now_.refused = decision.refused;
    account_.note(decision.refused, decision.detail);
  }
}

/// From here on hand and tip move together; whatever lay between them is the clutch's.
void SurgeonControl::engage() noexcept {
  now_.offset = hand_.position - now_.tip;
  now_.refused = NoteCode::None;
  coupling::begin_epoch(parts_.law, hand_.position - now_.offset);
}

coupling::SurgeonInput SurgeonControl::law_input(const link::Arrivals& arrived,
                                                 bool engaged_now) const noexcept {
  coupling::SurgeonInput in;
  in.now = now_.at;
  in.state = now_.state;
  in.position = hand_.position - now_.offset;
  in.velocity = hand_.velocity;
  in.force_applied = at_hand_.over(in.position - now_.position);
  in.round_trip = now_.link.round_trip;
  if (now_.state == SiteState::Engaged && !engaged_now) in.arrived = arrived.samples;
  return in;
}

/// [N] from which the hand presses, and does not only move air: what the peer's sensor feels.
double SurgeonControl::pressing_force() const noexcept {
  return felt_as_contact(now_.peer_devices.sensor.value_or(ForceSensorFacts{}));
}

SurgeonOutputs SurgeonControl::decide(const SurgeonInputs& in) noexcept {
  const Lapse lapse = account_.begin_tick(in.now);
  now_.at = in.now;
  at_hand_.give(now_.force, lapse.periods - 1);
  take_hand(in.hand);
  session_began_ = std::exchange(now_.link, in.link).session_id != in.link.session_id;
  if (session_began_) begin_session(in.peer_devices);
  hear(in.arrived);

  const SiteState before = now_.state;
  const SupervisorOutput decision = supervise(in, lapse);
  record_decision(decision, before);
  if (decision.engaged_now) engage();

  const coupling::SurgeonInput given = law_input(in.arrived, decision.engaged_now);
  const coupling::SurgeonOutput wanted = coupling::step(parts_.law, given, lapse);
  const bool cut = hand_.faulted || hand_.emergency_stop || in.user.emergency_stop;
  answer_ = gate_.pass({.force = wanted.force,
                        .way = decision.engaged_now ? 0 : given.position - now_.position,
                        .velocity = given.velocity,
                        .state = now_.state,
                        .pedal_held = hand_.pedal_held,
                        .cut = cut,
                        .fade_max = wanted.fade_max},
                       lapse);
  force_before_ = now_.force;
  now_.force = answer_.force;
  at_hand_.give(answer_.force, 1);
  now_.gate_acted = answer_.acted;
  now_.position = given.position;
  now_.place = hand_.place;
  judge_force(wanted, lapse);
  // What the hand is given, not what the law would have given: the tip presses by that. A hand that
  // is meant to be given none has the force before its eyes.
  PortSample told = wanted.to_patient;
  if (config_.gate.force_max > 0) told.force = answer_.force;
  return {.force = answer_.force,
          .hold_in_plane = config_.hold_in_plane && answer_.force >= pressing_force(),
          .to_peer = {{now_.state, now_.epoch, hand_.place, {}}, account_.within_limits(told)},
          .view = {.state = now_.state,
                   .peer_state = now_.peer_state,
                   .link = now_.link.state,
                   .tip_position = now_.tip,
                   .tip_known = now_.tip_known,
                   .map = now_.map.number,
                   .next = now_.map.next,
                   .enough_touches = now_.map.stop != MapStop::GoOn}};
}

/// A hand that feels less than the tissue must know it.
void SurgeonControl::judge_force(const coupling::SurgeonOutput& wanted,
                                 const Lapse& lapse) noexcept {
  now_.force_missing = now_.state == SiteState::Engaged ? wanted.force_missing : 0;
  const DeviceFacts& peer = now_.peer_devices;
  shortage_.look({.state = now_.state,
                  .missing = wanted.force_missing,
                  .too_stiff = wanted.force_too_stiff,
                  .apart = distance(now_.place, now_.peer_place),
                  .tip = {.given = now_.force,
                          .measured = coupling::force_scale(parts_.law) * now_.contact_force,
                          .position = now_.position,
                          .tip = now_.tip,
                          .round_trip = seconds(now_.link.round_trip)}},
                 {peer.stage.value_or(StageFacts{}), peer.sensor.value_or(ForceSensorFacts{})},
                 lapse);
  const NoteCode before = std::exchange(now_.shortage, shortage_.why());
  now_.short_by = shortage_.by();
  if (now_.shortage == before || now_.state != SiteState::Engaged) return;
  const bool whole = now_.shortage == NoteCode::None;
  account_.note(whole ? NoteCode::ForceComplete : now_.shortage, now_.short_by);
}

void SurgeonControl::write_down(const SurgeonInputs& in, const SurgeonOutputs& out) noexcept {
  if (answer_.note != NoteCode::None) account_.note(answer_.note, answer_.detail);
  account_.record(SiteTick{.at = now_.at,
                           .state = now_.state,
                           .epoch = now_.epoch,
                           .position = now_.position,
                           .velocity = hand_.velocity,
                           .force = force_before_,
                           .place = now_.place,
                           .command = now_.force,
                           .gate_acted = now_.gate_acted,
                           .round_trip = now_.link.round_trip,
                           .sent = out.to_peer.port,
                           .force_missing = now_.force_missing,
                           .short_by = now_.short_by,
                           .short_note = static_cast<std::uint16_t>(now_.shortage)});
  account_.link(in.link);
  note_script(in.script);
  record_readings(in);
  static_cast<record::SiteCounts&>(now_) = account_.counts();
}

void SurgeonControl::note_script(const ScriptProgress& script) noexcept {
  now_.script = script;
  if (!script.begun || script.phase == script_phase_) return;
  script_phase_ = script.phase;
  account_.note(NoteCode::ScriptPhase, script_phase_);
}

/// The inputs, so that they can be given again.
void SurgeonControl::record_readings(const SurgeonInputs& in) noexcept {
  account_.devices({.hand = facts_, .stage = {}, .sensor = {}}, in.peer_devices, session_began_);
  account_.user(in.user);
  account_.record(HandReading{.at = in.now,
                              .age = elapsed(in.hand.sampled_at, in.now),
                              .position = in.hand.position,
                              .velocity = in.hand.velocity,
                              .place = in.hand.place,
                              .pedal_held = in.hand.pedal_held,
                              .emergency_stop = in.hand.emergency_stop,
                              .faulted = in.hand.faulted,
                              .script_phase = in.script.begun ? in.script.phase : 0});
  account_.heard(in.link, in.arrived, in.arrived.peer.depth.number);
}

}  // namespace palp::surgeon
