#include "surgeon_site/devices_command.h"

#include <algorithm>
#include <cstdio>

#include "common/config/json.h"
#include "surgeon_site/devices/master_plan.h"

namespace palp::surgeon {

using config::ExitCode;
using site_program::ExitStatus;

DevicesCommand::DevicesCommand(config::CommandLine& line) {
  config::CommandLine& verb =
      line.verb("devices", "Lists the haptic masters: what is there, what can be used, why not.");
  verb.toggle("--json", json_, "as JSON, schema palp.devices/1");
}

ExitStatus DevicesCommand::run() const {
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
