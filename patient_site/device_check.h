#pragma once

#include <string>

#include "common/core/result.h"
#include "common/core/time.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/devices/device_plans.h"
#include "site_program/dialogue.h"

namespace palp::patient {

/// A guided check of one device of a site's file, over its real line. Thread: main. Blocks.
class DeviceCheck {
 public:
  /// All outlive it.
  DeviceCheck(const DevicePlans& plans, const io::SteadyClock& clock, site_program::Dialogue& talk)
      : plans_{plans}, clock_{clock}, talk_{talk} {}

  /// Whether the file has a device of that name: normal, x, y, cell, card.
  [[nodiscard]] bool known(const std::string& name) const;
  /// The settings of the file with what was found; an error: what is wrong with the device.
  [[nodiscard]] Result<std::string> run(const std::string& name, const std::string& file);

 private:
  [[nodiscard]] const DevicePlan* plan_named(const std::string& name) const;
  [[nodiscard]] Result<std::string> check_card(const std::string& file);
  [[nodiscard]] Result<std::string> check_modbus(const std::string& name, const std::string& file);

  const DevicePlans& plans_;
  const io::SteadyClock& clock_;
  site_program::Dialogue& talk_;
};

}  // namespace palp::patient
