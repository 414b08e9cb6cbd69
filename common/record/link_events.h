#pragma once

#include <cstdint>

#include "common/core/site_state.h"
#include "common/link/telegram.h"
#include "common/record/notes.h"

namespace palp::record {

/// What of the link's health is an event for the log: each change of its state, and other keys.
/// A value. Thread: rt.
class LinkEvents {
 public:
  /// Once a tick. `note`: called as note(NoteCode, detail).
  template <class Note>
  void look(const LinkHealth& now, const Note& note) noexcept {
    if (now.state != state_) tell_state(now, note);
    const bool same_session = now.session_id == session_id_ && session_id_ != 0;
    if (same_session && now.key != key_) note(NoteCode::KeysReplaced, static_cast<double>(now.key));
    state_ = now.state;
    session_id_ = now.session_id;
    key_ = now.key;
  }

 private:
  template <class Note>
  static void tell_state(const LinkHealth& now, const Note& note) noexcept {
    switch (now.state) {
      case LinkState::Down:
        return note(NoteCode::LinkIsDown, seconds(now.gap));
      case LinkState::Live:
        return note(NoteCode::LinkIsLive, seconds(now.round_trip));
      case LinkState::Hold:
        return note(NoteCode::LinkHolds, seconds(now.gap));
      case LinkState::Lost:
        return note(NoteCode::LinkIsLost, seconds(now.gap));
    }
  }

  LinkState state_{LinkState::Down};
  std::uint64_t session_id_{};
  std::uint8_t key_{};
};

}  // namespace palp::record
