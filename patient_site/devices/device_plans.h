#pragma once

#include <optional>
#include <string>

#include "common/core/device_facts.h"
#include "common/io/device/modbus_port.h"
#include "patient_site/devices/device_profile.h"
#include "patient_site/devices/scan_card.h"

namespace palp::patient {

/// One device, ready to be made.
struct DevicePlan {
  DeviceProfile profile;
  DeviceInstallation installation;
  io::ModbusAddress address;
  double lag{};    ///< [s]
  double pole{};   ///< [Hz]
  double noise{};  ///< [N], rms
  double yield{};  ///< [m/N]
};

/// A force card, ready to be made.
struct CardPlan {
  CardInstallation installation;
  std::string serial;  ///< empty: whichever is there
  double pole{};       ///< [Hz]
  double noise{};      ///< [N], rms
  double yield{};      ///< [m/N]
};

/// What stands behind `--devices FILE`.
struct DevicePlans {
  std::optional<DevicePlan> normal;
  std::optional<DevicePlan> x;
  std::optional<DevicePlan> y;
  std::optional<DevicePlan> cell;  ///< absent: the normal axis feels its load
  std::optional<CardPlan> card;    ///< on USB, in place of a cell
  std::string phantom;             ///< the tissue under them, where it is known; for whoever judges
  std::string text;                ///< of the file itself, calibrations included
};

/// A line that is slower than the profile's makes the device slower: its period, and its silence
/// with it, become what one reading and one write take there.
void fit_to_line(DeviceProfile& profile, const io::ModbusAddress& address) noexcept;
/// Of a stage put together from these; `normal` is there.
[[nodiscard]] StageFacts stage_facts_of(const DevicePlans& plans) noexcept;
/// Of what feels the force: the cell, or the normal axis.
[[nodiscard]] ForceSensorFacts sensor_facts_of(const DevicePlan& plan) noexcept;
[[nodiscard]] ForceSensorFacts sensor_facts_of(const CardPlan& plan) noexcept;
/// Of both; all that a rig needs is there.
[[nodiscard]] PatientDevices facts_of(const DevicePlans& plans) noexcept;
/// Of what feels the force: longer without a reading is a fault.
[[nodiscard]] Duration sensor_silence_of(const DevicePlans& plans) noexcept;

}  // namespace palp::patient
