#pragma once

#include <string>

#include "common/io/device/register_port.h"
#include "patient_site/devices/device_plans.h"

namespace palp::patient {

/// What a first look at a device gave.
struct DeviceLook {
  std::string place;    ///< "normal axis"
  std::string product;  ///< "Iris ORCA"
  std::string address;
  bool usable{};
  std::string found;  ///< what it reads, or why it cannot be used; for people
};

/// Opens, reads once, closes: nothing is written, nothing moves. Blocks for some time-outs.
[[nodiscard]] DeviceLook look_at(const std::string& place,
                                 const DevicePlan& plan,
                                 io::RegisterPort& port);

}  // namespace palp::patient
