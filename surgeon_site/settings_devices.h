#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.h"
#include "common/io/device/modbus_port.h"
#include "surgeon_site/devices/master_plan.h"

namespace palp::surgeon {

/// `text` is that of a SurgeonDeviceFile (proto/devices.proto), `name` its file, `master` as the
/// flag names it. The sentence names line, field and range.
[[nodiscard]] Result<MasterPlan> make_master_plan(const KnownMaster& master,
                                                  std::string_view text,
                                                  const std::string& name);
[[nodiscard]] Result<MasterPlan> read_master_plan(const KnownMaster& master,
                                                  const std::string& path);

/// Where the file says that a master at a Modbus line is; nullopt: nowhere.
[[nodiscard]] Result<std::optional<io::ModbusAddress>> line_in(std::string_view text,
                                                               const std::string& name);

/// The settings of the file's `text` with what a check found of its master, and without the file's
/// comments, as its first line says.
[[nodiscard]] Result<std::string> calibrated_text(std::string_view text,
                                                  const std::string& name,
                                                  const MasterPlan& found);

}  // namespace palp::surgeon
