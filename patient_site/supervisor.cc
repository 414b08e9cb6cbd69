#include "patient_site/supervisor.h"

namespace palp::patient {

using record::NoteCode;

bool PatientSupervisor::session_began(const SupervisorInput& in) const noexcept {
  return in.session_id != 0 && in.session_id != session_id_;
}

/// The surgeon's pedal opened an epoch that this site has not answered yet.
bool PatientSupervisor::engagement(const SupervisorInput& in) const noexcept {
  return in.link == LinkState::Live && in.peer_heard && in.peer.state == SiteState::Engaged &&
         in.peer.epoch > epoch_;
}

PatientSupervisor::Arrow PatientSupervisor::stop(const SupervisorInput& in) const noexcept {
  if (in.emergency_stop) return {SiteState::Stopped, NoteCode::EmergencyStop};
  if (in.device_fault != NoteCode::None) return {SiteState::Stopped, in.device_fault};
  // A stage that can only move out is not held in the tissue, nor kept from a reset, by its force.
  const bool may_press =
      state_ != SiteState::Parked && state_ != SiteState::Retract && state_ != SiteState::Stopped;
  if (in.force_exceeded && may_press) return {SiteState::Stopped, NoteCode::ForceLimit};
  if (in.peer_heard && in.peer.state == SiteState::Stopped && !peer_was_stopped_) {
    return {SiteState::Stopped, NoteCode::PeerStopped};
  }
  return {};
}

/// What ends contact whatever the peer says.
PatientSupervisor::Arrow PatientSupervisor::by_link(const SupervisorInput& in) const noexcept {
  if (in.link == LinkState::Down) return {SiteState::Retract, NoteCode::LinkDown};
  if (in.link == LinkState::Lost) return {SiteState::Retract, NoteCode::GapLost};
  return {};
}

/// What the peer's present report asks of a site that was engaged.
PatientSupervisor::Arrow PatientSupervisor::by_peer(const SupervisorInput& in) const noexcept {
  if (!in.peer_heard || in.peer.epoch < epoch_) return {};
  if (in.peer.state == SiteState::Clutched) return {SiteState::Clutched, NoteCode::PeerClutched};
  if (in.peer.state == SiteState::Retract || in.peer.state == SiteState::Parked) {
    return {SiteState::Retract, NoteCode::PeerRetracting};
  }
  return {};
}

PatientSupervisor::Arrow PatientSupervisor::decide(const SupervisorInput& in) const noexcept {
  const Arrow stopping = stop(in);
  if (state_ == SiteState::Stopped) {
    if (stopping.reason != NoteCode::None || !in.local_reset) return {};
    return {SiteState::Parked, NoteCode::LocalReset};
  }
  if (stopping.reason != NoteCode::None) return stopping;
  if (state_ == SiteState::Parked) {
    const bool peer_ready = in.peer_heard && in.peer.state != SiteState::Stopped;
    if (in.link != LinkState::Live || !peer_ready || !in.retracted) return {};
    return {SiteState::Clutched, NoteCode::LinkReady};
  }
  if (state_ == SiteState::Retract) {
    if (!in.retracted) return {};
    return {SiteState::Parked, NoteCode::RetractDone};
  }
  const Arrow lost = by_link(in);
  if (lost.reason != NoteCode::None) return lost;
  if (state_ == SiteState::Clutched) {
    if (!engagement(in) || in.overslept) return {};
    // Nobody could ever engage again over a tip that stands in the tissue: it is walked out.
    if (!in.free_to_follow) return {SiteState::Retract, NoteCode::EngageRefusedForce};
    return {SiteState::Engaged, NoteCode::PeerEngaged};
  }
  // Engaged or Hold.
  if (session_began(in)) return {SiteState::Retract, NoteCode::SessionBegan};
  // What it was told while it slept is old: the stage stays until the pedal is pressed again.
  if (in.overslept) return {SiteState::Clutched, NoteCode::TickLate};
  if (state_ == SiteState::Hold && in.link == LinkState::Hold) return {};
  const Arrow told = by_peer(in);
  if (told.reason != NoteCode::None) return told;
  if (engagement(in) && !in.free_to_follow) return {SiteState::Clutched, NoteCode::PeerClutched};
  if (state_ == SiteState::Engaged && in.link == LinkState::Hold) {
    return {SiteState::Hold, NoteCode::GapHold};
  }
  if (state_ == SiteState::Hold && in.link == LinkState::Live) {
    return {SiteState::Engaged, NoteCode::GapOver};
  }
  return {};
}

SupervisorOutput PatientSupervisor::step(const SupervisorInput& in) noexcept {
  SupervisorOutput out;
  out.session_began = session_began(in);
  if (out.session_began) epoch_ = 0;
  const SiteState before = state_;
  const Arrow arrow = decide(in);
  if (out.session_began) session_id_ = in.session_id;
  out.reason = arrow.reason;
  if (arrow.reason != NoteCode::None) state_ = arrow.to;

  // A site that becomes ready takes the peer's epoch as answered: only a new press engages it.
  const bool asked = engagement(in);
  if (state_ == SiteState::Engaged && asked) {
    out.engaged_now = true;
    epoch_ = in.peer.epoch;
  } else if (before == SiteState::Parked && state_ == SiteState::Clutched) {
    epoch_ = in.peer.epoch;
  } else if (asked && (before == SiteState::Clutched || before == SiteState::Engaged ||
                       before == SiteState::Hold)) {
    epoch_ = in.peer.epoch;
    out.refused = in.overslept ? NoteCode::TickLate : NoteCode::EngageRefusedForce;
    out.detail = in.contact_force;
  }
  if (out.reason == NoteCode::ForceLimit) out.detail = in.contact_force;
  out.resumed_now = out.reason == NoteCode::GapOver;
  if (in.peer_heard) peer_was_stopped_ = in.peer.state == SiteState::Stopped;
  out.state = state_;
  out.epoch = epoch_;
  return out;
}

}  // namespace palp::patient
