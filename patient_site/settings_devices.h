#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.h"
#include "patient_site/devices/device_plans.h"
#include "patient_site/settings.h"

namespace palp::patient {

/// `text` is that of a PatientDeviceFile (proto/devices.proto), `name` its file. The sentence names
/// line, field and range; relative profiles are looked for from the working folder.
[[nodiscard]] Result<DevicePlans> make_device_plans(std::string_view text, const std::string& name);
[[nodiscard]] Result<DevicePlans> read_device_plans(const std::string& path);

/// What stands behind the settings' file of devices, with what follows from it for the site: the
/// phantom and how long its sensor may be silent. Nothing: the stage is simulated.
[[nodiscard]] Result<std::optional<DevicePlans>> plan_devices(Settings& settings);

/// The settings of the file's `text` with what a check found of one of its devices, "normal", "x",
/// "y" or "cell", and without the file's comments, as its first line says.
[[nodiscard]] Result<std::string> calibrated_text(std::string_view text,
                                                  const std::string& name,
                                                  std::string_view place,
                                                  const DevicePlan& found);
/// The same of its card.
[[nodiscard]] Result<std::string> calibrated_text(std::string_view text,
                                                  const std::string& name,
                                                  const CardPlan& found);

/// A profile by its name, "iai", or "file:PATH".
[[nodiscard]] Result<DeviceProfile> find_profile(const std::string& name);

}  // namespace palp::patient
