#pragma once

#include <cstdint>

#include "common/core/site_state.h"
#include "common/core/time.h"
#include "common/link/telegram.h"
#include "common/record/notes.h"

namespace palp::surgeon {

struct SupervisorConfig {
  Duration retract_after_gap{std::chrono::seconds{2}};  ///< in Hold
  Duration retract_span{std::chrono::seconds{1}};       ///< the law fades the force meanwhile
  /// The peer's answer to an engagement is a round trip away, and none may exceed 2.5 s.
  Duration follow_within{std::chrono::seconds{3}};
  /// No engagement above it; 0: any. `direct` is not stable under delay: 20 ms, unless forced.
  Duration round_trip_max_to_engage{};
};

/// All that a decision may depend on.
struct SupervisorInput {
  TimePoint now{};
  bool pedal_held{};
  bool emergency_stop{};
  bool device_faulted{};
  bool overslept{};            ///< this tick is late beyond what a law may go on over
  bool local_reset{};          ///< the user's way out of Stopped, true for one tick
  LinkState link{};            ///< Live only once the round trip was measured
  std::uint64_t session_id{};  ///< 0: none
  Duration gap{};
  Duration round_trip{};
  SiteReport peer;
  bool peer_heard{};
  bool tip_known{};  ///< without it the clutch has nothing to align with
};

/// `reason` and `refused` are None where nothing changed and nothing was refused.
struct SupervisorOutput {
  SiteState state{};
  std::uint32_t epoch{};
  bool engaged_now{};         ///< this tick opened the epoch
  bool session_began{};       ///< another session than the last one
  record::NoteCode reason{};  ///< of the change of state
  record::NoteCode refused{};
  double detail{};  ///< [by code], of `refused`
};

/// The surgeon's half of the site states: says when the peer's samples may cause force. A pure
/// machine: its output depends on nothing but config, the inputs so far and their order.
/// A report of an older epoch moves nothing, unless it says Stopped. With a new session epochs
/// count from 0 again, because the peer may be a process that has just started. Thread: rt. A
/// value.
class SurgeonSupervisor {
 public:
  explicit SurgeonSupervisor(const SupervisorConfig& config) noexcept : config_{config} {}
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
  [[nodiscard]] Arrow from_parked(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow from_clutched(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow from_engaged(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow from_hold(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow from_retract(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow from_stopped(const SupervisorInput& in) const noexcept;
  [[nodiscard]] Arrow by_peer_or_pedal(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool session_began(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool pedal_pressed(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool ready_to_engage(const SupervisorInput& in) const noexcept;
  [[nodiscard]] bool round_trip_too_long(const SupervisorInput& in) const noexcept;
  void remember(const SupervisorInput& in) noexcept;

  SupervisorConfig config_;
  SiteState state_{SiteState::Parked};
  std::uint32_t epoch_{};
  TimePoint entered_at_{};
  TimePoint engaged_at_{};
  std::uint64_t session_id_{};   ///< of the last session there was; 0: none yet
  bool pedal_was_held_{true};    ///< held from the start is no edge
  bool peer_was_stopped_{true};  ///< Stopped from the start is no change, Parked waits for its end
  bool lost_in_hold_{};
};

}  // namespace palp::surgeon
