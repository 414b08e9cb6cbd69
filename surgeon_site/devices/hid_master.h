#pragma once

#include <memory>
#include <string>

#include "common/core/mailbox.h"
#include "common/io/device/report_port.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "surgeon_site/devices/master_device.h"
#include "surgeon_site/haptic_device.h"

namespace palp::surgeon {

/// A master on a thread of its own, at 1 kHz where its line allows it, between mailboxes.
class MasterThread {
 public:
  /// Starts at once. `name`: for people and the log. `priority`: SCHED_FIFO, 0: none.
  MasterThread(std::string name,
               std::unique_ptr<MasterProtocol> protocol,
               const MasterInstallation& installation,
               std::unique_ptr<io::ReportPort> port,
               int priority);
  /// Ends the thread, then takes the force away.
  ~MasterThread();
  MasterThread(const MasterThread&) = delete;
  MasterThread& operator=(const MasterThread&) = delete;

  /// Thread: rt. The newest, wait-free.
  [[nodiscard]] const MasterReading& reading() noexcept { return to_rt_.get(); }
  void command(const MasterCommand& command) noexcept { command_.put(command); }
  /// Thread: main.
  [[nodiscard]] const MasterReading& status() noexcept { return to_main_.get(); }
  /// Thread: main. Out of a fault, if it is in one, to the beginning of its start.
  void restart() noexcept { restarts_.put(++restarted_); }
  /// Thread: any.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  void cycle();

  std::string name_;
  std::unique_ptr<io::ReportPort> port_;
  MasterDevice device_;
  io::SteadyClock clock_;
  Mailbox<MasterReading> to_rt_;     ///< writer: device; reader: rt
  Mailbox<MasterReading> to_main_;   ///< writer: device; reader: main
  Mailbox<MasterCommand> command_;   ///< writer: rt; reader: device
  Mailbox<std::uint32_t> restarts_;  ///< writer: main; reader: device
  std::uint32_t restarted_{};        ///< main's
  io::PeriodicThread thread_;        ///< last: it uses all of the above
};

/// A master as the site sees it. Thread: rt; `master` outlives it.
class HidMaster final : public HapticDevice {
 public:
  HidMaster(MasterThread& master, const HandFacts& facts) noexcept
      : master_{master}, facts_{facts} {}

  [[nodiscard]] HandFacts hand_facts() const noexcept override { return facts_; }
  HandState read(TimePoint now) noexcept override;
  void apply(double force) noexcept override;
  void show(const OperatorView& view) noexcept override;

 private:
  MasterThread& master_;
  HandFacts facts_;
  MasterCommand command_;
  TimePoint at_{};  ///< of the last read
};

}  // namespace palp::surgeon
