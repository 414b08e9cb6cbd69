#include "surgeon_site/devices_command.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "common/config/json.h"
#include "common/config/report.h"
#include "common/core/whole_file.h"
#include "common/io/device/hid_port.h"
#include "common/io/realtime/steady_clock.h"
#include "surgeon_site/devices/master_plan.h"
#include "surgeon_site/devices/master_rig.h"
#include "surgeon_site/master_check.h"
#include "surgeon_site/settings_devices.h"

namespace palp::surgeon {

using config::ExitCode;
using site_program::ExitStatus;

DevicesCommand::DevicesCommand(config::CommandLine& line) {
  config::CommandLine& verb =
      line.verb("devices", "Lists the haptic masters: what is there, what can be used, why not.");
  verb.argument("test", what_, "instead of the list: a guided check that writes a calibration");
  verb.argument("NAME", name_, "of the master to check: openffboard, paddle, spacemouse");
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
                                   "'; there are: openffboard, paddle, spacemouse");
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
  io::HidPort port{address_of(*plan)};
  const io::SteadyClock clock;
  site_program::Dialogue talk{std::cin, std::cout};
  MasterCheck check{*plan, port, clock, [&](Duration span) { clock.pass(span); }, talk};
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
    products.push_back({std::string{one.name}, addresses_of(one.kind)});
  }
  const std::vector<io::HidLook> looks = io::look_for_hid(products);
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
