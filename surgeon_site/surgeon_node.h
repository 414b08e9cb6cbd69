#pragma once

#include <cstdint>

#include "common/core/mailbox.h"
#include "common/core/time.h"
#include "common/core/user_command.h"
#include "common/coupling/any_coupling.h"
#include "common/link/link.h"
#include "common/record/recorder.h"
#include "surgeon_site/haptic_device.h"
#include "surgeon_site/sample_hold.h"
#include "surgeon_site/surgeon_control.h"
#include "surgeon_site/surgeon_status.h"

namespace palp::surgeon {

/// The surgeon's site, one tick at a time: reads the hand, hears the link, does what its control
/// decides of them, and lets it write all down. Owns the control, makes no parts. Thread: rt.
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
  /// How often somebody else than the user at the terminal asked to stop: each is an emergency
  /// stop. Writer: the monitor's thread. Reader: rt.
  [[nodiscard]] Mailbox<std::uint32_t>& stops() noexcept { return stops_; }
  /// How long what arrives is held back, so that touch is as old as the picture beside it; 0: not.
  /// Writer: the video's thread. Reader: rt.
  [[nodiscard]] Mailbox<Duration>& touch_hold() noexcept { return touch_hold_; }
  /// Writer: rt. Reader: the display's thread.
  [[nodiscard]] Mailbox<SurgeonStatus>& status() noexcept { return status_; }

 private:
  [[nodiscard]] SurgeonInputs read(TimePoint now) noexcept;

  Parts parts_;
  SurgeonControl control_;
  Mailbox<UserCommand> commands_;
  Mailbox<std::uint32_t> stops_;
  std::uint32_t stopped_{};  ///< so many of them were obeyed
  Mailbox<Duration> touch_hold_;
  SampleHold held_;
  Mailbox<SurgeonStatus> status_;
};

}  // namespace palp::surgeon
