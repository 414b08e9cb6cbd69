#include "common/record/notes.h"

namespace palp::record {

std::string_view to_string(NoteCode code) noexcept {
  switch (code) {
    case NoteCode::None:
      return "";
    case NoteCode::LinkReady:
      return "link ready";
    case NoteCode::PedalPressed:
      return "pedal pressed";
    case NoteCode::PedalReleased:
      return "pedal released";
    case NoteCode::PeerEngaged:
      return "peer engaged";
    case NoteCode::PeerClutched:
      return "peer clutched";
    case NoteCode::PeerRetracting:
      return "peer is retracting";
    case NoteCode::PeerStopped:
      return "peer stopped";
    case NoteCode::GapHold:
      return "nothing arrived: hold";
    case NoteCode::GapLost:
      return "nothing arrived for long: link lost";
    case NoteCode::GapOver:
      return "samples arrive again";
    case NoteCode::LinkDown:
      return "no session with the peer";
    case NoteCode::RetractDone:
      return "retracted, clear of the tissue";
    case NoteCode::ForceLimit:
      return "force limit reached";
    case NoteCode::DeviceFault:
      return "device fault";
    case NoteCode::EmergencyStop:
      return "emergency stop";
    case NoteCode::LocalReset:
      return "reset on the spot";
    case NoteCode::EngageRefusedForce:
      return "engagement refused: contact force too high";
    case NoteCode::ForceGateClamped:
      return "force gate limited the force on the hand";
    case NoteCode::MotionGateLimited:
      return "motion gate limited the stage";
    case NoteCode::ForceRetreat:
      return "contact force too high: the stage retreats";
    case NoteCode::NotFinite:
      return "a value was not finite";
    case NoteCode::SessionBegan:
      return "new session with the peer";
    case NoteCode::RoundTripTooLong:
      return "round trip too long for this coupling: engagement refused";
    case NoteCode::ScriptPhase:
      return "next phase of the script";
    case NoteCode::LinkIsDown:
      return "the link is down: no session";
    case NoteCode::LinkIsLive:
      return "the link is live";
    case NoteCode::LinkHolds:
      return "the link holds: nothing arrived";
    case NoteCode::LinkIsLost:
      return "the link is lost: nothing arrived for long";
    case NoteCode::KeysReplaced:
      return "telegrams come under new keys";
    case NoteCode::DragRefused:
      return "the stage cannot drag: it keeps its place while pressed";
    case NoteCode::PlaceBeyondTravel:
      return "a place beyond the stage's travel";
  }
  return "unknown note";
}

std::string state_text(SiteState state, NoteCode reason, NoteCode refused) {
  std::string name{palp::to_string(state)};
  switch (state) {
    case SiteState::Hold:
    case SiteState::Retract:
    case SiteState::Stopped:
      return name + " (" + std::string{to_string(reason)} + ")";
    case SiteState::Clutched:
      if (refused == NoteCode::None) break;
      return name + " (" + std::string{to_string(refused)} + ")";
    case SiteState::Parked:
    case SiteState::Engaged:
      break;
  }
  return name;
}

}  // namespace palp::record
