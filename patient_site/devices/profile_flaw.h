#pragma once

#include <optional>
#include <string>

#include "patient_site/devices/device_profile.h"

namespace palp::patient {

/// Why such a device cannot be: a field outside what is read, a condition that never holds, a
/// number that its kind cannot hold, an axis that is never sent anywhere or never stopped, a text
/// that a terminal would obey, a range that is none. nullopt: sound.
[[nodiscard]] std::optional<std::string> flaw_of(const DeviceProfile& profile,
                                                 const DeviceInstallation& installation);

}  // namespace palp::patient
