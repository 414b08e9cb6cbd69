#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mailbox.h"
#include "common/io/device/register_port.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/devices/device_requests.h"
#include "patient_site/devices/register_device.h"
#include "patient_site/force_sensor.h"
#include "patient_site/stage.h"

namespace palp::patient {

/// A device on a thread of its own, at its own rate, between mailboxes.
class DeviceThread {
 public:
  /// Starts at once. `name`: for people and the log, "stage x". `priority`: SCHED_FIFO, 0: none.
  DeviceThread(std::string name,
               DeviceProfile profile,
               const DeviceInstallation& installation,
               std::unique_ptr<io::RegisterPort> port,
               int priority);
  /// Ends the thread, then tells the device to stand still.
  ~DeviceThread();
  DeviceThread(const DeviceThread&) = delete;
  DeviceThread& operator=(const DeviceThread&) = delete;

  /// Thread: rt. The newest, wait-free.
  [[nodiscard]] const DeviceReading& reading() noexcept { return to_rt_.get(); }
  void command(const DeviceCommand& command) noexcept { command_.put(command); }
  /// It was ready, and its newest reading was too old: it may be stuck in a call.
  void count_silence() noexcept { silences_.fetch_add(1, std::memory_order_relaxed); }
  /// Thread: main.
  [[nodiscard]] const DeviceReading& status() noexcept { return to_main_.get(); }
  [[nodiscard]] std::uint32_t silences() const noexcept {
    return silences_.load(std::memory_order_relaxed);
  }
  /// Threads: main and rt, each its own.
  [[nodiscard]] DeviceRequests& requests() noexcept { return requests_; }
  /// Thread: any.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const DeviceProfile& profile() const noexcept { return device_.profile(); }

 private:
  void cycle();

  std::string name_;
  std::unique_ptr<io::RegisterPort> port_;
  RegisterDevice device_;
  io::SteadyClock clock_;
  Mailbox<DeviceReading> to_rt_;    ///< writer: device; reader: rt
  Mailbox<DeviceReading> to_main_;  ///< writer: device; reader: main
  Mailbox<DeviceCommand> command_;  ///< writer: rt; reader: device
  DeviceRequests requests_;
  std::atomic<std::uint32_t> silences_{};
  io::PeriodicThread thread_;  ///< last: it uses all of the above
};

/// A stage of one axis along the normal, or of three, of any makers. Thread: rt; `axes` outlive it.
class RegisterStage final : public Stage {
 public:
  /// normal, x, y; the last two are given or absent both. Facts are sound.
  RegisterStage(std::array<DeviceThread*, 3> axes, const StageFacts& facts) noexcept
      : axes_{axes}, facts_{facts} {}

  [[nodiscard]] StageFacts stage_facts() const noexcept override { return facts_; }
  StageState read(TimePoint now) noexcept override;
  void move_to(const StageTarget& target) noexcept override;
  void halt() noexcept override;

 private:
  [[nodiscard]] bool silent(std::size_t index, const DeviceReading& axis, TimePoint now) noexcept;

  std::array<DeviceThread*, 3> axes_;
  StageFacts facts_;
  TimePoint at_{};                ///< of the last read
  TimePoint awake_since_{};       ///< the caller stood still, until then
  std::array<bool, 3> silent_{};  ///< at the last read
};

/// The reading of a load cell, or of an axis that feels its own load. Thread: rt; `cell` outlives
/// it.
class RegisterForce final : public ForceSensor {
 public:
  RegisterForce(DeviceThread& cell, const ForceSensorFacts& facts) noexcept
      : cell_{cell}, facts_{facts} {}

  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override { return facts_; }
  /// Nothing while the cell is not ready: its last reading grows old.
  std::optional<ForceSample> sample(TimePoint now) noexcept override;
  void expect_touch(bool may_touch) noexcept override { cell_.requests().expect_touch(may_touch); }

 private:
  DeviceThread& cell_;
  ForceSensorFacts facts_;
  std::uint64_t number_{};
};

}  // namespace palp::patient
