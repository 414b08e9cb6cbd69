#pragma once

#include <functional>

#include "common/core/result.h"
#include "patient_site/devices/device_plans.h"
#include "patient_site/devices/register_device.h"
#include "patient_site/devices/scan_card.h"
#include "site_program/dialogue.h"

namespace palp::patient {

/// As it is built in, but for its zero: what it reads unloaded, a check is to find.
[[nodiscard]] DeviceInstallation with_any_zero(DeviceInstallation built_in) noexcept;

/// check_sensor() of a device that is read over Modbus: the plan with the zero, the unit, the
/// direction and the noise that were found. `pass` waits for so long. Thread: main. Blocks.
[[nodiscard]] Result<DevicePlan> check_cell(DevicePlan plan,
                                            io::RegisterPort& port,
                                            const Clock& clock,
                                            const std::function<void(Duration)>& pass,
                                            site_program::Dialogue& talk);
/// The same of a card.
[[nodiscard]] Result<CardPlan> check_card(CardPlan plan,
                                          const ScanCard::Ports& ports,
                                          const Clock& clock,
                                          const std::function<void(Duration)>& pass,
                                          site_program::Dialogue& talk);

}  // namespace palp::patient
