#include "patient_site/devices_command.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/io/device/hid_look.h"
#include "common/io/device/modbus_port.h"
#include "common/io/realtime/steady_clock.h"
#include "patient_site/device_check.h"
#include "patient_site/settings_devices.h"

namespace palp::patient {

using config::ExitCode;
using site_program::ExitStatus;

namespace {

DeviceLook look_at_card(const CardPlan& plan) {
  const CardModel& model = card_model(plan.installation.kind);
  const std::string name{model.name};
  io::HidAddress commands = ScanCard::address(model, 0);
  commands.serial = plan.serial;
  const io::HidLook seen = io::look_for_hid({{name, {commands}}}).front();
  DeviceLook look;
  look.place = "force sensor";
  look.product = name;
  look.address = seen.address.empty() ? "hid" : seen.address;
  look.usable = seen.usable;
  look.found = seen.found;
  // It looks the same, and yet no HID interface of it will ever be listed.
  if (seen.address.empty()) {
    look.found +=
        "; a " + name.substr(name.find(' ') + 1) + "-Plus is no HID device and cannot be used";
  }
  return look;
}

}  // namespace

DevicesCommand::DevicesCommand(config::CommandLine& line) {
  config::CommandLine& verb =
      line.verb("devices", "Lists the devices of a file: what is there, what it reads, why not.");
  verb.argument("test", what_, "instead of the list: a guided check that writes a calibration");
  verb.argument("NAME", name_, "of the device to check: normal, x, y, cell, card");
  verb.text("--devices", file_, "FILE", "where devices are and what they are");
  verb.text("--write", write_, "FILE", "where its calibration goes: a new file");
  verb.toggle("--json", json_, "as JSON, schema palp.devices/1");
}

ExitStatus DevicesCommand::run() const {
  if (file_.empty()) return site_program::bad_input("devices needs --devices FILE");
  const auto plans = read_device_plans(file_);
  if (!plans) return site_program::exit_status_of(plans.error());
  if (what_.empty()) return list(*plans);
  if (what_ != "test") return site_program::bad_input("devices knows 'test', not '" + what_ + "'");
  return test(*plans);
}

ExitStatus DevicesCommand::test(const DevicePlans& plans) const {
  if (write_.empty()) return site_program::bad_input("devices test needs --write FILE");
  if (std::filesystem::exists(write_)) {
    return site_program::bad_input("'" + write_ + "' is there already; it is not written over");
  }
  if (const auto writes = config::can_write_file(write_); !writes) {
    return site_program::exit_status_of(writes.error());
  }
  const io::SteadyClock clock;
  site_program::Dialogue talk{std::cin, std::cout};
  DeviceCheck check{plans, clock, talk};
  const auto calibrated = check.run(name_, file_);
  if (!calibrated) {
    return check.known(name_) ? ExitStatus{ExitCode::Missed, "not usable", calibrated.error().text}
                              : site_program::bad_input(calibrated.error().text);
  }
  if (const auto written = config::write_whole_file(write_, *calibrated); !written) {
    return site_program::exit_status_of(written.error());
  }
  talk.say("written to " + write_);
  return {ExitCode::Done, "completed", ""};
}

ExitStatus DevicesCommand::list(const DevicePlans& plans) const {
  std::vector<DeviceLook> looks;
  const auto look = [&](const char* place, const std::optional<DevicePlan>& plan) {
    if (!plan) return;
    io::ModbusPort port{plan->address};
    looks.push_back(look_at(place, *plan, port));
  };
  look("normal axis", plans.normal);
  look("x axis", plans.x);
  look("y axis", plans.y);
  look("force sensor", plans.cell);
  if (plans.card) looks.push_back(look_at_card(*plans.card));
  std::fputs((json_ ? devices_json(looks) : devices_text(looks)).c_str(), stdout);
  if (std::ranges::all_of(looks, &DeviceLook::usable)) return {ExitCode::Done, "completed", ""};
  return {ExitCode::Missed, "not usable", "not all devices can be used"};
}

std::string devices_text(const std::vector<DeviceLook>& looks) {
  std::string text;
  for (const DeviceLook& one : looks) {
    text += (one.usable ? "usable      " : "not usable  ") + one.place + " (" + one.product + ", " +
            one.address + "): " + one.found + "\n";
  }
  return text;
}

std::string devices_json(const std::vector<DeviceLook>& looks) {
  config::Json json;
  json["schema"] = "palp.devices/1";
  json["devices"] = config::Json::array();
  for (const DeviceLook& one : looks) {
    json["devices"].push_back({{"place", one.place},
                               {"product", one.product},
                               {"address", one.address},
                               {"usable", one.usable},
                               {"found", one.found}});
  }
  return json.dump(2) + "\n";
}

}  // namespace palp::patient
