#pragma once

#include <cstdint>

#include "common/core/site_state.h"
#include "common/link/telegram.h"
#include "common/record/notes.h"

namespace palp::patient {

/// All that a decision may depend on.
struct SupervisorInput {
  LinkState link{};
  std::uint64_t session_id{};  ///< 0: none
  SiteReport peer;
  bool peer_heard{};
  bool emergency_stop{};
  record::NoteCode device_fault{};  ///< the reason to stop; None: they do their work
  bool overslept{};                 ///< this tick is late beyond what a law may go on over
  bool force_exceeded{};            ///< the contact force is beyond what a site may go on with
  bool local_reset{};               ///< the user's way out of Stopped, true for one tick
  bool free_to_follow{};            ///< no contact, or clear of the surface
  bool retracted{};                 ///< the tip stands clear
  double contact_force{};           ///< [N], for the notes
};

/// `reason` and `refused` are None where nothing changed and nothing was refused.
struct SupervisorOutput {
  SiteState state{};
  std::uint32_t epoch{};
  bool engaged_now{};    ///< follows a new epoch from this tick on
  bool resumed_now{};    ///< out of Hold
  bool session_began{};  ///< another session than the last one
  record::NoteCode reason{};
  record::NoteCode refused{};
  double detail{};  ///< [by code], of reason and refused
};

/// The patient's half of the site states: says when the peer's samples may cause motion. A pure
/// machine: its output depends on the inputs so far and their order alone.
/// The surgeon opens epochs; the patient follows a new one unless the tip stands in tissue: then it
/// stays Clutched in the new epoch, which sends the surgeon back to Clutched. A report of an older
/// epoch moves nothing, unless it says Stopped. A new session counts epochs from 0: its peer may be
/// a process that has just started. Thread: rt. A value.
class PatientSupervisor {
 public:
  SupervisorOutput step(const SupervisorInput& in) noexcept;

  [[nodiscard]] SiteState state() const noexcept { return state_; }
  [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }

 private:
  /// Where to go and why; reason None: stay.
  struct Arrow {
    SiteState to{};
    record::NoteCode reason{};
  };

  [[nodiscard]] Arrow decide(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow stop(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow by_link(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow by_peer(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool session_began(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool engagement(const SupervisorInput& in) const noexcept;

  SiteState state_{SiteState::Parked};
  std::uint32_t epoch_{};
  std::uint64_t session_id_{};   ///< of the last session there was; 0: none yet
  bool peer_was_stopped_{true};  ///< Stopped from the start is no change, Parked waits for its end
};

}  // namespace palp::patient
