#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/time.h"
#include "patient_site/devices/card_thread.h"
#include "patient_site/devices/device_plans.h"
#include "patient_site/devices/register_stage.h"

namespace palp::patient {

struct DeviceNews {
  std::string sentence;  ///< "x axis (IAI ROBO Cylinder): absent, no reply"
  bool fit{};
};

/// The devices of a site, each on its thread, and what the site sees of them.
/// Thread: main; stage() and sensor(): rt.
class DeviceRig {
 public:
  /// Starts the threads; none is ready yet. `priority` of theirs: SCHED_FIFO, 0: none.
  DeviceRig(const DevicePlans& plans, int priority);

  [[nodiscard]] bool ready() noexcept;
  /// Why it will not be ready any more, `waited` after its making: a device reports a fault, is not
  /// there for 5 s, or starts for 90 s.
  [[nodiscard]] std::optional<std::string> hopeless(Duration waited);
  /// Whoever changed its state since the last call.
  [[nodiscard]] std::vector<DeviceNews> news();
  /// Out of their faults, from the beginning of their start.
  void restart() noexcept;
  /// A new tare of what feels the force; news() says what became of it. It is refused, and ends,
  /// where something touches, the sensor is not ready, or the site expects a touch.
  void tare() noexcept;

  [[nodiscard]] Stage& stage() noexcept { return *stage_; }
  [[nodiscard]] ForceSensor& sensor() noexcept { return *force_; }

 private:
  [[nodiscard]] DeviceThread* add(const std::string& name,
                                  const std::optional<DevicePlan>& plan,
                                  int priority);
  struct Known {
    DeviceState state{};
    DeviceReason reason{};
    TareNews tare;
    std::uint32_t silences{};
  };

  std::vector<std::unique_ptr<DeviceThread>> threads_;
  std::vector<Known> known_;  ///< as told last, of each
  std::unique_ptr<RegisterStage> stage_;
  std::unique_ptr<CardThread> card_;  ///< null: the force is felt over Modbus
  std::string card_name_;
  CardState card_state_{};     ///< as told last
  TareNews card_tare_;         ///< as told last
  std::string_view card_why_;  ///< as told last
  std::unique_ptr<ForceSensor> force_;
  DeviceRequests* feeling_{};  ///< of what feels the force
};

}  // namespace palp::patient
