#pragma once

#include <string>

#include "common/config/command_line.h"
#include "common/io/device/hid_look.h"
#include "site_program/exit_status.h"

namespace palp::surgeon {

/// The verb `devices`: which masters are there, and why one cannot be used. Moves none.
class DevicesCommand {
 public:
  /// Declares the verb; this object outlives the line's parse().
  explicit DevicesCommand(config::CommandLine& line);
  /// After the line was parsed with this verb. Missed where none can be used.
  [[nodiscard]] site_program::ExitStatus run() const;

 private:
  bool json_{};
};

/// A line for each.
[[nodiscard]] std::string devices_text(const std::vector<io::HidLook>& looks);
/// Schema palp.devices/1.
[[nodiscard]] std::string devices_json(const std::vector<io::HidLook>& looks);

}  // namespace palp::surgeon
