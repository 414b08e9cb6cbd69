#include "surgeon_site/supervisor.h"

#include <algorithm>

namespace palp::surgeon {

using record::NoteCode;

bool SurgeonSupervisor::session_began(const SupervisorInput& in) const noexcept {
  return in.session_id != 0 && in.session_id != session_id_;
}

bool SurgeonSupervisor::pedal_pressed(const SupervisorInput& in) const noexcept {
  return in.pedal_held && !pedal_was_held_;
}

bool SurgeonSupervisor::ready_to_engage(const SupervisorInput& in) const noexcept {
  return pedal_pressed(in) && !in.overslept && in.link == LinkState::Live && in.peer_heard &&
         in.peer.state == SiteState::Clutched && in.tip_known;
}

bool SurgeonSupervisor::round_trip_too_long(const SupervisorInput& in) const noexcept {
  return config_.round_trip_max_to_engage > Duration{0} &&
         in.round_trip > config_.round_trip_max_to_engage;
}

SurgeonSupervisor::Arrow SurgeonSupervisor::stop(const SupervisorInput& in) const noexcept {
  if (in.emergency_stop) return {SiteState::Stopped, NoteCode::EmergencyStop};
  if (in.device_faulted) return {SiteState::Stopped, NoteCode::DeviceFault};
  if (in.peer_heard && in.peer.state == SiteState::Stopped && !peer_was_stopped_) {
    return {SiteState::Stopped, NoteCode::PeerStopped};
  }
  return {};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_parked(const SupervisorInput& in) const noexcept {
  const bool peer_ready = in.peer_heard && in.peer.state != SiteState::Stopped;
  if (in.link == LinkState::Live && peer_ready) return {SiteState::Clutched, NoteCode::LinkReady};
  return {};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_clutched(
    const SupervisorInput& in) const noexcept {
  if (in.link == LinkState::Down) return {SiteState::Retract, NoteCode::LinkDown};
  if (in.link == LinkState::Lost) return {SiteState::Retract, NoteCode::GapLost};
  if (ready_to_engage(in) && !round_trip_too_long(in)) {
    return {SiteState::Engaged, NoteCode::PedalPressed};
  }
  return {};
}

/// What ends a session of the hand whatever the gap: in Engaged and in Hold alike. What happened to
/// the pedal while the site slept nobody knows: it must be pressed again.
SurgeonSupervisor::Arrow SurgeonSupervisor::by_peer_or_pedal(
    const SupervisorInput& in) const noexcept {
  if (session_began(in)) return {SiteState::Retract, NoteCode::SessionBegan};
  if (in.link == LinkState::Down) return {SiteState::Retract, NoteCode::LinkDown};
  if (in.overslept) return {SiteState::Clutched, NoteCode::TickLate};
  if (in.peer_heard && in.peer.epoch >= epoch_) {
    if (in.peer.state == SiteState::Retract || in.peer.state == SiteState::Parked) {
      return {SiteState::Retract, NoteCode::PeerRetracting};
    }
    if (in.peer.state == SiteState::Clutched) return {SiteState::Clutched, NoteCode::PeerClutched};
  }
  const bool unanswered = !in.peer_heard || in.peer.epoch < epoch_;
  if (unanswered && in.now - engaged_at_ > config_.follow_within) {
    return {SiteState::Clutched, NoteCode::PeerClutched};
  }
  if (!in.pedal_held) return {SiteState::Clutched, NoteCode::PedalReleased};
  return {};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_engaged(const SupervisorInput& in) const noexcept {
  const Arrow arrow = by_peer_or_pedal(in);
  if (arrow.reason != NoteCode::None) return arrow;
  if (in.link != LinkState::Live) return {SiteState::Hold, NoteCode::GapHold};
  return {};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_hold(const SupervisorInput& in) const noexcept {
  const Arrow arrow = by_peer_or_pedal(in);
  if (arrow.reason != NoteCode::None) return arrow;
  const bool lost_is_over = lost_in_hold_ && in.link != LinkState::Lost;
  if (lost_is_over || in.gap > config_.retract_after_gap) {
    return {SiteState::Retract, NoteCode::GapLost};
  }
  if (in.link == LinkState::Live) return {SiteState::Engaged, NoteCode::GapOver};
  return {};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_retract(const SupervisorInput& in) const noexcept {
  if (in.now - entered_at_ < config_.retract_span) return {};
  return {SiteState::Parked, NoteCode::RetractDone};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::from_stopped(const SupervisorInput& in) const noexcept {
  if (!in.local_reset) return {};
  return {SiteState::Parked, NoteCode::LocalReset};
}

SurgeonSupervisor::Arrow SurgeonSupervisor::decide(const SupervisorInput& in) const noexcept {
  const Arrow stopping = stop(in);
  if (stopping.reason != NoteCode::None) {
    return state_ == SiteState::Stopped ? Arrow{} : stopping;
  }
  switch (state_) {
    case SiteState::Parked:
      return from_parked(in);
    case SiteState::Clutched:
      return from_clutched(in);
    case SiteState::Engaged:
      return from_engaged(in);
    case SiteState::Hold:
      return from_hold(in);
    case SiteState::Retract:
      return from_retract(in);
    case SiteState::Stopped:
      return from_stopped(in);
  }
  return {};
}

void SurgeonSupervisor::remember(const SupervisorInput& in) noexcept {
  pedal_was_held_ = in.pedal_held;
  if (in.peer_heard) peer_was_stopped_ = in.peer.state == SiteState::Stopped;
  if (session_began(in)) session_id_ = in.session_id;
  lost_in_hold_ = state_ == SiteState::Hold && (lost_in_hold_ || in.link == LinkState::Lost);
}

SupervisorOutput SurgeonSupervisor::step(const SupervisorInput& in) noexcept {
  SupervisorOutput out;
  out.session_began = session_began(in);
  if (out.session_began) epoch_ = 0;
  const Arrow arrow = decide(in);
  out.reason = arrow.reason;
  if (arrow.reason != NoteCode::None) {
    out.engaged_now = arrow.reason == NoteCode::PedalPressed;
    // Above the peer's too: a restarted surgeon must not open an epoch the patient has left.
    if (out.engaged_now) {
      epoch_ = std::max(epoch_, in.peer.epoch) + 1;
      engaged_at_ = in.now;
    }
    state_ = arrow.to;
    entered_at_ = in.now;
  } else if (state_ == SiteState::Clutched && ready_to_engage(in)) {
    out.refused = NoteCode::RoundTripTooLong;
    out.detail = seconds(in.round_trip);
  }
  remember(in);
  out.state = state_;
  out.epoch = epoch_;
  return out;
}

}  // namespace palp::surgeon
