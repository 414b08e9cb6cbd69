#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/core/mailbox.h"
#include "common/io/realtime/periodic_thread.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/devices/device_requests.h"
#include "patient_site/devices/scan_card.h"
#include "patient_site/force_sensor.h"

namespace palp::patient {

/// A force card on a thread of its own at 1 kHz, between mailboxes.
class CardThread {
 public:
  using Ports = std::vector<std::unique_ptr<io::ReportPort>>;
  /// Starts at once. `priority`: SCHED_FIFO, 0: none.
  CardThread(const CardInstallation& installation, Ports ports, int priority);
  /// Ends the thread, then the scan.
  ~CardThread();
  CardThread(const CardThread&) = delete;
  CardThread& operator=(const CardThread&) = delete;

  /// Thread: rt. The newest, wait-free.
  [[nodiscard]] const CardReading& reading() noexcept { return to_rt_.get(); }
  /// Thread: main.
  [[nodiscard]] const CardReading& status() noexcept { return to_main_.get(); }
  /// Threads: main and rt, each its own.
  [[nodiscard]] DeviceRequests& requests() noexcept { return requests_; }

 private:
  void cycle();

  Ports ports_;
  ScanCard card_;
  io::SteadyClock clock_;
  Mailbox<CardReading> to_rt_;    ///< writer: device; reader: rt
  Mailbox<CardReading> to_main_;  ///< writer: device; reader: main
  DeviceRequests requests_;
  io::PeriodicThread thread_;  ///< last: it uses all of the above
};

/// A card's channel as the site's force sensor. Thread: rt; `card` outlives it.
class CardForce final : public ForceSensor {
 public:
  CardForce(CardThread& card, const ForceSensorFacts& facts) noexcept
      : card_{card}, facts_{facts} {}

  [[nodiscard]] ForceSensorFacts sensor_facts() const noexcept override { return facts_; }
  /// Nothing while the card is not ready: its last reading grows old.
  std::optional<ForceSample> sample(TimePoint now) noexcept override;
  void expect_touch(bool may_touch) noexcept override { card_.requests().expect_touch(may_touch); }

 private:
  CardThread& card_;
  ForceSensorFacts facts_;
  std::uint64_t number_{};
};

}  // namespace palp::patient
