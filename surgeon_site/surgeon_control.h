#pragma once

#include <bitset>
#include <cstdint>

#include "common/core/device_facts.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/coupling/any_coupling.h"
#include "common/link/telegram.h"
#include "common/record/recorder.h"
#include "common/record/site_account.h"
#include "surgeon_site/force_at_hand.h"
#include "surgeon_site/force_gate.h"
#include "surgeon_site/force_shortage.h"
#include "surgeon_site/haptic_device.h"
#include "surgeon_site/supervisor.h"
#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

struct SurgeonConfig {
  Duration period{std::chrono::milliseconds{1}};
  SupervisorConfig supervisor;
  ForceGateConfig gate;  ///< the device's own limits are kept as well
  bool hold_in_plane{};  ///< tell the device to lock its plane while the hand presses
  Duration link_status_every{std::chrono::milliseconds{100}};
};

/// All that a tick is given. The session file holds the same, but for the names of a script.
struct SurgeonInputs {
  TimePoint now{};
  HandState hand;
  ScriptProgress script;
  UserCommand user;
  link::Arrivals arrived;  ///< its samples are valid until the next receive() of the link
  LinkHealth link;
  DeviceFacts peer_devices;  ///< says something where the session is another than a tick ago
};

/// All that a tick wants done.
struct SurgeonOutputs {
  double force{};        ///< [N], + pushes out
  bool hold_in_plane{};  ///< the device locks its plane, if it can
  Telegram to_peer;
  OperatorView view;
};

/// What the surgeon's site does with a tick: from the same inputs, in the same order, the same
/// outputs and records, bit for bit. Touches no device and no link. Lets the supervisor decide,
/// steps the law, passes its force through the gate, and records all of it. The law is given the
/// samples that arrived in state Engaged only, and not those of the tick that opened the epoch:
/// they were sent before it. Owns supervisor and gate. Thread: rt.
class SurgeonControl {
 public:
  /// All outlive it.
  struct Parts {
    coupling::SurgeonCoupling& law;
    record::Recorder& recorder;
  };

  SurgeonControl(const SurgeonConfig& config, const HandFacts& hand, Parts parts) noexcept;

  /// Both halves of a tick, for whoever has nothing to do in between.
  SurgeonOutputs step(const SurgeonInputs& in) noexcept {
    const SurgeonOutputs out = decide(in);
    write_down(in, out);
    return out;
  }
  /// Once a tick, then write_down() with the same inputs: what is to be done is done in between.
  [[nodiscard]] SurgeonOutputs decide(const SurgeonInputs& in) noexcept;
  void write_down(const SurgeonInputs& in, const SurgeonOutputs& out) noexcept;

  /// After write_down().
  [[nodiscard]] const SurgeonStatus& status() const noexcept { return now_; }

 private:
  /// Which cells of the newest map came.
  struct HeardCells {
    std::uint32_t number{};  ///< of the map; 0: none yet
    std::bitset<kMapCellsMax> indices;
  };

  void take_hand(const HandState& read) noexcept;
  void begin_session(const DeviceFacts& peer) noexcept;
  void hear(const link::Arrivals& arrived) noexcept;
  void hear(MapCell cell) noexcept;
  [[nodiscard]] SupervisorOutput supervise(const SurgeonInputs& in, const Lapse& lapse) noexcept;
  void record_decision(const SupervisorOutput& decision, SiteState before) noexcept;
  void engage() noexcept;
  [[nodiscard]] coupling::SurgeonInput law_input(const link::Arrivals& arrived,
                                                 bool engaged_now) const noexcept;
  [[nodiscard]] double pressing_force() const noexcept;
  void judge_force(const coupling::SurgeonOutput& wanted, const Lapse& lapse) noexcept;
  void note_script(const ScriptProgress& script) noexcept;
  void record_readings(const SurgeonInputs& in) noexcept;

  SurgeonConfig config_;
  HandFacts facts_;
  ForceAtHand at_hand_;
  Parts parts_;
  SurgeonSupervisor supervisor_;
  ForceGate gate_;
  record::SiteAccount account_;
  SurgeonStatus now_;  ///< of this tick: what is shown, and what one tick leaves to the next
  HandState hand_;     ///< last one with numbers
  ForceAnswer answer_;
  HeardCells cells_;
  ForceShortage shortage_;
  double force_before_{};  ///< [N], applied in the tick before
  bool hand_was_finite_{true};
  bool session_began_{};          ///< or ended, in this tick
  std::uint32_t resets_{};        ///< last heard of
  std::uint32_t script_phase_{};  ///< last noted
};

}  // namespace palp::surgeon
