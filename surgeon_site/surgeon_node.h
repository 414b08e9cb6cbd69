#pragma once

#include <cstdint>
#include <optional>

#include "common/core/mailbox.h"
#include "common/core/time.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/record/link_events.h"
#include "common/record/recorder.h"
#include "surgeon_site/force_gate.h"
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

/// What the user asks of the site by other means than the device. The newest counts.
struct UserCommand {
  bool emergency_stop{};   ///< as long as it is set
  std::uint32_t resets{};  ///< one more: leave state Stopped
};

/// The surgeon's site, one tick at a time: reads the hand, hears the link, lets the supervisor
/// decide, steps the law, passes its force through the gate, and sends and records all of it.
/// The law is given the samples that arrived in state Engaged only, and not those of the tick that
/// opened the epoch: they were sent before it. Owns supervisor and gate, makes no parts.
/// Thread: rt.
class SurgeonNode {
 public:
  /// All outlive the node.
  struct Parts {
    HapticDevice& device;
    coupling::SurgeonCoupling& law;
    link::Link& link;
    record::Recorder& recorder;
  };

  SurgeonNode(const SurgeonConfig& config, Parts parts);

  /// The only thing that moves this site. Once a period; a late call counts the periods missed.
  void tick(TimePoint now) noexcept;

  /// Writer: the user's thread. Reader: rt.
  [[nodiscard]] Mailbox<UserCommand>& commands() noexcept { return commands_; }
  /// Writer: rt. Reader: the display's thread.
  [[nodiscard]] Mailbox<SurgeonStatus>& status() noexcept { return status_; }

 private:
  [[nodiscard]] Duration time_passed(TimePoint now) noexcept;
  [[nodiscard]] HandState read_hand(TimePoint now) noexcept;
  void forget_peer() noexcept;
  void hear(const link::Arrivals& arrived) noexcept;
  [[nodiscard]] SupervisorOutput supervise(const HandState& hand,
                                           const link::Arrivals& arrived) noexcept;
  void engage(const HandState& hand) noexcept;
  void record_decision(const SupervisorOutput& decision, SiteState before) noexcept;
  void record_script() noexcept;
  void record_link(TimePoint now) noexcept;
  void note(record::NoteCode code, double detail = 0) noexcept;
  void record(const Record& record) noexcept;

  SurgeonConfig config_;
  Parts parts_;
  SurgeonSupervisor supervisor_;
  ForceGate gate_;
  Mailbox<UserCommand> commands_;
  Mailbox<SurgeonStatus> status_;
  SurgeonStatus now_;  ///< of this tick: what is shown, and what one tick leaves to the next
  record::LinkEvents link_events_;
  HandState hand_;  ///< last one with numbers
  bool hand_was_finite_{true};
  bool begun_{};
  std::uint32_t resets_{};        ///< last heard of
  std::uint32_t script_phase_{};  ///< last noted
  std::optional<TimePoint> link_recorded_at_;
};

}  // namespace palp::surgeon
