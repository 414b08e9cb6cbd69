#pragma once

#include <string>

#include "common/config/command_line.h"
#include "common/io/device/hid_look.h"
#include "site_program/exit_status.h"

namespace palp::surgeon {

/// The verb `devices`: which masters are there, and why one cannot be used; `devices test NAME`: a
/// guided check of one, which ends in a calibration file. Moves none but in such a check.
class DevicesCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit DevicesCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Missed where none can be used.
  [[nodiscard]] site_program::ExitStatus run() const;

 private:
  [[nodiscard]] site_program::ExitStatus list() const;
  [[nodiscard]] site_program::ExitStatus test() const;

  std::string what_;
  std::string name_;
  std::string file_;
  std::string write_;
  bool json_{};
};

/// A line for each.
[[nodiscard]] std::string devices_text(const std::vector<io::HidLook>& looks);
/// Schema palp.devices/1.
[[nodiscard]] std::string devices_json(const std::vector<io::HidLook>& looks);

}  // namespace palp::surgeon
