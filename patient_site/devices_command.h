#pragma once

#include <string>
#include <vector>

#include "common/config/command_line.h"
#include "patient_site/devices/device_look.h"
#include "site_program/exit_status.h"

namespace palp::patient {

/// The verb `devices`: which of them are there, what they read, why one cannot be used; `devices
/// test NAME`: a guided check of one, which ends in a calibration file. Moves none but in such a
/// check.
class DevicesCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit DevicesCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Missed where one cannot be used.
  [[nodiscard]] site_program::ExitStatus run() const;

 private:
  [[nodiscard]] site_program::ExitStatus list(const DevicePlans& plans) const;
  [[nodiscard]] site_program::ExitStatus test(const DevicePlans& plans) const;

  std::string what_;
  std::string name_;
  std::string write_;
  std::string file_;
  bool json_{};
};

/// A line for each.
[[nodiscard]] std::string devices_text(const std::vector<DeviceLook>& looks);
/// Schema palp.devices/1.
[[nodiscard]] std::string devices_json(const std::vector<DeviceLook>& looks);

}  // namespace palp::patient
