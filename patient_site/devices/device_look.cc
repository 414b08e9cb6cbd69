#include "patient_site/devices/device_look.h"

#include <array>
#include <cstdio>

#include <unistd.h>

#include "patient_site/devices/register_words.h"

namespace palp::patient {
namespace {

constexpr int kTries = 3;

std::string address_text(const io::ModbusAddress& address) {
  if (!address.line.empty()) return "serial:" + address.line;
  return "tcp:" + address.host + ":" + std::to_string(address.port);
}

std::string why_not(io::PortFault fault, const DevicePlan& plan) {
  const io::ModbusAddress& address = plan.address;
  std::string text{io::to_string(fault)};
  if (fault == io::PortFault::Refused) {
    const int first = plan.profile.read_address;
    return text + ": it has no registers " + std::to_string(first) + " to " +
           std::to_string(first + plan.profile.read_count - 1) + "; is that its profile?";
  }
  if (fault != io::PortFault::NotOpen || address.line.empty()) return text;
  const char* const line = address.line.c_str();
  if (::access(line, F_OK) != 0) return text + ": there is no such line";
  if (::access(line, R_OK | W_OK) != 0) {
    return text + ": no permission; its group, often dialout, may use it";
  }
  return text;
}

std::string reading_text(const char* what, double value, const char* unit) {
  std::array<char, 64> text{};
  (void)std::snprintf(text.data(), text.size(), "%s %.3f %s", what, value, unit);
  return text.data();
}

/// In the device's own axis, not tared.
std::string readings(const DevicePlan& plan, const ReadWords& words) {
  const DeviceProfile& profile = plan.profile;
  const DeviceInstallation& built_in = plan.installation;
  std::string text;
  if (profile.position) {
    const double unit =
        built_in.position_unit > 0 ? built_in.position_unit : profile.position->unit;
    text = reading_text("reads", words.counts(*profile.position, profile.order) * unit * 1e3, "mm");
  }
  if (profile.force) {
    const double unit = built_in.force_unit > 0 ? built_in.force_unit : profile.force->unit;
    text += (text.empty() ? "" : ", ") +
            reading_text("reads", words.counts(*profile.force, profile.order) * unit, "N");
  }
  for (const RegisterCondition& one : profile.healthy) {
    if (words.holds(one.address, 1) && !words.meets(one)) text += ", " + one.means;
  }
  return text;
}

}  // namespace

DeviceLook look_at(const std::string& place, const DevicePlan& plan, io::RegisterPort& port) {
  DeviceLook look;
  look.place = place;
  look.product = plan.profile.name;
  look.address = address_text(plan.address);
  io::PortFault fault = port.open();
  ReadWords words{plan.profile.read_address, plan.profile.read_count};
  if (fault == io::PortFault::None) {
    for (int i = 0; i < kTries; ++i) {
      fault = port.read(plan.profile.read_address, words.words(), plan.profile.input_registers);
      if (fault == io::PortFault::None) break;
    }
  }
  port.close();
  look.usable = fault == io::PortFault::None;
  look.found = look.usable ? readings(plan, words) : why_not(fault, plan);
  return look;
}

}  // namespace palp::patient
