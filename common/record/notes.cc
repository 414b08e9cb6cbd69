#include "common/record/notes.h"

#include <algorithm>
#include <array>

namespace palp::record {
namespace {

struct Text {
  NoteCode code;
  std::string_view text;
};

constexpr std::array kTexts{
    Text{NoteCode::None, ""},
    Text{NoteCode::LinkReady, "link ready"},
    Text{NoteCode::PedalPressed, "pedal pressed"},
    Text{NoteCode::PedalReleased, "pedal released"},
    Text{NoteCode::PeerEngaged, "peer engaged"},
    Text{NoteCode::PeerClutched, "peer clutched"},
    Text{NoteCode::PeerRetracting, "peer is retracting"},
    Text{NoteCode::PeerStopped, "peer stopped"},
    Text{NoteCode::GapHold, "nothing arrived: hold"},
    Text{NoteCode::GapLost, "nothing arrived for long: link lost"},
    Text{NoteCode::GapOver, "samples arrive again"},
    Text{NoteCode::LinkDown, "no session with the peer"},
    Text{NoteCode::RetractDone, "retracted, clear of the tissue"},
    Text{NoteCode::ForceLimit, "force limit reached"},
    Text{NoteCode::DeviceFault, "device fault"},
    Text{NoteCode::EmergencyStop, "emergency stop"},
    Text{NoteCode::LocalReset, "reset on the spot"},
    Text{NoteCode::TickLate, "this site's program stood still: press the pedal again"},
    Text{NoteCode::StageStuck, "the stage does not go where it is sent"},
    Text{NoteCode::SensorStuck, "the force sensor does not follow the tip in contact"},
    Text{NoteCode::SensorSilent, "the force sensor is silent"},
    Text{NoteCode::SensorSaturated, "the force sensor is at the end of its range"},
    Text{NoteCode::EngageRefusedForce, "engagement refused: contact force too high"},
    Text{NoteCode::ForceGateClamped, "force gate limited the force on the hand"},
    Text{NoteCode::MotionGateLimited, "motion gate limited the stage"},
    Text{NoteCode::ForceRetreat, "contact force too high: the stage retreats"},
    Text{NoteCode::NotFinite, "a value was not finite"},
    Text{NoteCode::SessionBegan, "new session with the peer"},
    Text{NoteCode::RoundTripTooLong, "round trip too long for this coupling: engagement refused"},
    Text{NoteCode::ScriptPhase, "next phase of the script"},
    Text{NoteCode::LinkIsDown, "the link is down: no session"},
    Text{NoteCode::LinkIsLive, "the link is live"},
    Text{NoteCode::LinkHolds, "the link holds: nothing arrived"},
    Text{NoteCode::LinkIsLost, "the link is lost: nothing arrived for long"},
    Text{NoteCode::KeysReplaced, "telegrams come under new keys"},
    Text{NoteCode::DragRefused, "the stage cannot drag: it keeps its place while pressed"},
    Text{NoteCode::PlaceBeyondTravel, "a place beyond the stage's travel"},
    Text{NoteCode::ForceIncomplete, "the force is incomplete: lift once"},
    Text{NoteCode::ForceComplete, "the force is complete again"},
    Text{NoteCode::Marked, "a moment marked by the operator"},
    Text{NoteCode::MarkAsked, "a client of the monitor asked for a mark"},
    Text{NoteCode::StopAsked, "a client of the monitor asked to stop"},
    Text{NoteCode::ResetAsked, "a client of the monitor asked for a reset"},
    Text{NoteCode::EndAsked, "a client of the monitor ended the session"},
    Text{NoteCode::PointerTaken, "a client of the monitor took the pointer"},
    Text{NoteCode::PointerGiven, "a client of the monitor gave the pointer back"},
    Text{NoteCode::StudyTrial, "a trial of the study is offered"},
    Text{NoteCode::StudyInterval, "an interval of the trial may be touched"},
    Text{NoteCode::StudyAnswer, "the trial was answered"},
    Text{NoteCode::DiskNearlyFull, "the disk of the session file is nearly full"},
    Text{NoteCode::TissueTooStiff,
         "the force is incomplete: the tissue is stiffer than can be shown"},
    Text{NoteCode::TipFeelsMore, "the force is incomplete: the tip feels more"},
    Text{NoteCode::TipElsewhere, "the force may be incomplete: the tip is not where the hand is"},
};

}  // namespace

std::string_view to_string(NoteCode code) noexcept {
  const auto found = std::ranges::find(kTexts, code, &Text::code);
  return found != kTexts.end() ? found->text : "unknown note";
}

std::string state_text(SiteState state, NoteCode reason, NoteCode refused) {
  std::string name{palp::to_string(state)};
  switch (state) {
    case SiteState::Hold:
    case SiteState::Retract:
    case SiteState::Stopped:
      return name + " (" + std::string{to_string(reason)} + ")";
    case SiteState::Clutched:
      if (refused == NoteCode::None) {
        if (reason != NoteCode::TickLate) break;
        refused = reason;
      }
      return name + " (" + std::string{to_string(refused)} + ")";
    case SiteState::Parked:
    case SiteState::Engaged:
      break;
  }
  return name;
}

}  // namespace palp::record
