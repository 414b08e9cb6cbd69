#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/site_state.h"

/// Numbered notes and the reasons of state changes: rt leaves a number, people read the text.
namespace palp::record {

enum class NoteCode : std::uint16_t {
  None = 0,
  // Reasons of a site's state changes.
  LinkReady = 1,
  PedalPressed = 2,
  PedalReleased = 3,
  PeerEngaged = 4,
  PeerClutched = 5,
  PeerRetracting = 6,
  PeerStopped = 7,
  GapHold = 8,
  GapLost = 9,
  GapOver = 10,
  LinkDown = 11,
  RetractDone = 12,
  ForceLimit = 13,
  DeviceFault = 14,
  EmergencyStop = 15,
  LocalReset = 16,
  TickLate = 17,
  StageStuck = 18,
  SensorStuck = 19,
  SensorSilent = 20,
  SensorSaturated = 21,
  // Events.
  EngageRefusedForce = 32,  ///< detail: contact force [N]
  ForceGateClamped = 33,    ///< detail: force asked for [N]
  MotionGateLimited = 34,   ///< detail: position asked for [m]
  ForceRetreat = 35,        ///< detail: contact force [N]
  NotFinite = 36,           ///< a law or a device gave NaN or infinity
  SessionBegan = 37,        ///< a new peer session; samples of the old one count no more
  RoundTripTooLong = 38,    ///< detail: round trip [s]; `direct` refuses to engage
  ScriptPhase = 39,         ///< detail: number of the script's phase that begins
  LinkIsDown = 40,          ///< the session has ended; detail: gap [s], 0 where the peer ended it
  LinkIsLive = 41,          ///< detail: round trip [s]
  LinkHolds = 42,           ///< detail: gap [s]
  LinkIsLost = 43,          ///< detail: gap [s]
  KeysReplaced = 44,        ///< telegrams come under other keys; detail: their id
  DragRefused = 45,         ///< the stage cannot; detail: distance to the place asked for [m]
  PlaceBeyondTravel = 46,   ///< detail: likewise
  ForceIncomplete = 47,     ///< the hand feels less than the tissue; detail: missing [N]
  ForceComplete = 48,       ///< again all of it
  // From here on of no tick, up to DiskNearlyFull: who replays one leaves them out.
  Marked = 49,  ///< by who sat at the terminal, or a client; detail: number of the mark
  // Asked for by a client of the monitor; detail: its number.
  MarkAsked = 50,
  StopAsked = 51,
  ResetAsked = 52,
  EndAsked = 53,
  PointerTaken = 54,
  PointerGiven = 55,
  // Of a study whose participant is at this site.
  StudyTrial = 56,     ///< is offered; detail: its number in the block, practice included, from 1
  StudyInterval = 57,  ///< may be touched; detail: which, from 1
  StudyAnswer = 58,    ///< as it arrived; detail: the interval chosen, from 1
  // Of the recording itself, written by the record thread.
  DiskNearlyFull = 64,  ///< detail: time left [s] at the rate of late
  // Again of a tick. As ForceIncomplete, and over with ForceComplete; detail: missing [N], 0 where
  // nobody can say.
  TissueTooStiff = 65,
  TipFeelsMore = 66,
  TipElsewhere = 67,
};

/// Whether the control of a site notes it in one of its ticks, and not somebody beside it.
[[nodiscard]] constexpr bool is_of_a_tick(NoteCode code) noexcept {
  return code < NoteCode::Marked || code > NoteCode::DiskNearlyFull;
}

/// The text of a note, for people. Unknown codes give "unknown note".
[[nodiscard]] std::string_view to_string(NoteCode code) noexcept;
[[nodiscard]] inline std::string_view note_text(std::uint16_t code) noexcept {
  return to_string(static_cast<NoteCode>(code));
}

/// A site's state on its status line, and why, where it is not the usual one: "CLUTCHED", "RETRACT
/// (peer is retracting)". `refused`: why the last engagement was, None: it was not.
[[nodiscard]] std::string state_text(SiteState state, NoteCode reason, NoteCode refused);

}  // namespace palp::record
