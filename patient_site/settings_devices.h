#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/core/device_facts.h"
#include "common/core/result.h"
#include "common/io/device/modbus_port.h"
#include "patient_site/devices/device_profile.h"

namespace palp::patient {

/// One device, ready to be made.
struct DevicePlan {
  DeviceProfile profile;
  DeviceInstallation installation;
  io::ModbusAddress address;
  double lag{};    ///< [s]
  double pole{};   ///< [Hz]
  double noise{};  ///< [N], rms
};

/// What stands behind `--devices FILE`.
struct DevicePlans {
  std::optional<DevicePlan> normal;
  std::optional<DevicePlan> x;
  std::optional<DevicePlan> y;
  std::optional<DevicePlan> cell;
};

/// `text` is that of a PatientDeviceFile (proto/devices.proto), `name` its file. The sentence names
/// line, field and range; relative profiles are looked for from the working folder.
[[nodiscard]] Result<DevicePlans> make_device_plans(std::string_view text, const std::string& name);
[[nodiscard]] Result<DevicePlans> read_device_plans(const std::string& path);

/// A profile by its name, "iai", or "file:PATH".
[[nodiscard]] Result<DeviceProfile> find_profile(const std::string& name);

/// Of a stage put together from these; `normal` is there.
[[nodiscard]] StageFacts stage_facts_of(const DevicePlans& plans) noexcept;
/// Of what feels the force: the cell, or the normal axis.
[[nodiscard]] ForceSensorFacts sensor_facts_of(const DevicePlan& plan) noexcept;

}  // namespace palp::patient
