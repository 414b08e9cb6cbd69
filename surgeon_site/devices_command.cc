#include "surgeon_site/devices_command.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "common/io/device/hid_port.h"
#include "common/io/device/modbus_port.h"
#include "common/io/realtime/steady_clock.h"
#include "surgeon_site/devices/master_plan.h"
#include "surgeon_site/devices/master_rig.h"
#include "surgeon_site/master_check.h"
#include "surgeon_site/settings_devices.h"

namespace palp::surgeon {

using config::ExitCode;
using site_program::ExitStatus;

namespace {

/// Of a motor at a Modbus line, which nobody finds but by its file. Reads, and writes nothing.
io::HidLook look_at_shaft(const io::ModbusAddress& line) {
  const KnownMaster* const motor = master_named("orca");
  io::ModbusPort port{line};
  std::array<std::uint16_t, 2> place{};
  io::PortFault fault = port.open();
  if (fault == io::PortFault::None) fault = port.read(ShaftMotor::kPlaceAt, place, false);
  io::HidLook look{.product = std::string{motor->name},
                   .address = line.line.empty() ? "tcp:" + line.host : "serial:" + line.line,
                   .usable = fault == io::PortFault::None,
                   .found = std::string{io::to_string(fault)}};
  if (look.usable) look.found = "answers";
  return look;
}

}  // namespace

DevicesCommand::DevicesCommand(config::CommandLine& line) {
  config::CommandLine& verb =
      line.verb("devices", "Lists the haptic masters: what is there, what can be used, why not.");
  verb.argument("test", what_, "instead of the list: a guided check that writes a calibration");
  verb.argument("NAME", name_, "of the master to check: openffboard, paddle, spacemouse, orca");
  verb.text("--devices", file_, "FILE", "how it is built in, as far as that is known");
  verb.text("--write", write_, "FILE", "where its calibration goes: a new file");
  verb.toggle("--json", json_, "as JSON, schema palp.devices/1");
}

ExitStatus DevicesCommand::run() const {
  if (what_.empty()) return list();
  if (what_ != "test") return site_program::bad_input("devices knows 'test', not '" + what_ + "'");
  return test();
}

ExitStatus DevicesCommand::test() const {
  const KnownMaster* const master = master_named(name_);
  if (master == nullptr) {
    return site_program::bad_input("devices test knows no master '" + name_ +
                                   "'; there are: openffboard, paddle, spacemouse, orca");
  }
  if (write_.empty()) return site_program::bad_input("devices test needs --write FILE");
  if (std::filesystem::exists(write_)) {
    return site_program::bad_input("'" + write_ + "' is there already; it is not written over");
  }
  const auto text = file_.empty() ? Result<std::string>{""} : read_whole_file(file_);
  if (!text) return site_program::exit_status_of(text.error());
  const std::string name = file_.empty() ? "no file" : file_;
  const auto plan = make_master_plan(*master, *text, name);
  if (!plan) return site_program::exit_status_of(plan.error());
  if (const auto writes = config::can_write_file(write_); !writes) {
    return site_program::exit_status_of(writes.error());
  }
  const std::unique_ptr<io::ReportPort> port = make_port(*plan);
  const io::SteadyClock clock;
  site_program::Dialogue talk{std::cin, std::cout};
  MasterCheck check{*plan, *port, clock, [&](Duration span) { clock.pass(span); }, talk};
  const auto found = check.run();
  if (!found) return {ExitCode::Missed, "not usable", found.error().text};
  const auto calibrated = calibrated_text(*text, name, *found);
  if (!calibrated) return site_program::exit_status_of(calibrated.error());
  if (const auto written = config::write_whole_file(write_, *calibrated); !written) {
    return site_program::exit_status_of(written.error());
  }
  talk.say("written to " + write_);
  return {ExitCode::Done, "completed", ""};
}

ExitStatus DevicesCommand::list() const {
  std::vector<io::HidProduct> products;
  for (const KnownMaster& one : known_masters()) {
    if (addresses_of(one.kind).empty()) continue;  // its line is not looked for
    products.push_back({std::string{one.name}, addresses_of(one.kind)});
  }
  std::vector<io::HidLook> looks = io::look_for_hid(products);
  if (!file_.empty()) {
    const auto text = read_whole_file(file_);
    if (!text) return site_program::exit_status_of(text.error());
    const auto line = line_in(*text, file_);
    if (!line) return site_program::exit_status_of(line.error());
    if (*line) looks.push_back(look_at_shaft(**line));
  }
  std::fputs((json_ ? devices_json(looks) : devices_text(looks)).c_str(), stdout);
  if (std::ranges::any_of(looks, &io::HidLook::usable)) return {ExitCode::Done, "completed", ""};
  return {ExitCode::Missed, "not usable", "no master can be used"};
}

std::string devices_text(const std::vector<io::HidLook>& looks) {
  std::string text;
  for (const io::HidLook& one : looks) {
    text += (one.usable ? "usable      " : "not usable  ") + one.product +
            (one.address.empty() ? "" : " (" + one.address + ")") + ": " + one.found + "\n";
  }
  return text;
}

std::string devices_json(const std::vector<io::HidLook>& looks) {
  config::Json json;
  json["schema"] = "palp.devices/1";
  json["devices"] = config::Json::array();
  for (const io::HidLook& one : looks) {
    json["devices"].push_back({{"place", "master"},
                               {"product", one.product},
                               {"address", one.address},
                               {"usable", one.usable},
                               {"found", one.found}});
  }
  return json.dump(2) + "\n";
}

}  // namespace palp::surgeon
