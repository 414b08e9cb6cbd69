#include "patient_site/device_check.h"

#include <memory>
#include <utility>
#include <vector>

#include "common/io/device/hid_port.h"
#include "common/io/device/modbus_port.h"
#include "patient_site/axis_check.h"
#include "patient_site/force_check.h"
#include "patient_site/settings_devices.h"

namespace palp::patient {

const DevicePlan* DeviceCheck::plan_named(const std::string& name) const {
  const std::optional<DevicePlan>* const plan = name == "normal" ? &plans_.normal
                                                : name == "x"    ? &plans_.x
                                                : name == "y"    ? &plans_.y
                                                : name == "cell" ? &plans_.cell
                                                                 : nullptr;
  return plan != nullptr && *plan ? &**plan : nullptr;
}

bool DeviceCheck::known(const std::string& name) const {
  return (name == "card" && plans_.card) || plan_named(name) != nullptr;
}

Result<std::string> DeviceCheck::run(const std::string& name, const std::string& file) {
  if (!known(name)) {
    return fail(file + " has no device '" + name + "'; the names are: normal, x, y, cell, card");
  }
  return name == "card" ? check_card(file) : check_modbus(name, file);
}

Result<std::string> DeviceCheck::check_modbus(const std::string& name, const std::string& file) {
  DevicePlan plan = *plan_named(name);
  io::ModbusPort port{plan.address};
  const auto pass = [this](Duration span) { clock_.pass(span); };
  if (!plan.profile.move.empty()) {
    auto found = AxisCheck{plan, port, clock_, pass, talk_}.run();
    if (!found) return tl::unexpected{found.error()};
    plan = std::move(*found);
  }
  if (plan.profile.force) {
    auto felt = check_cell(plan, port, clock_, pass, talk_);
    if (!felt) return tl::unexpected{felt.error()};
    plan = std::move(*felt);
  }
  return calibrated_text(plans_.text, file, name, plan);
}

Result<std::string> DeviceCheck::check_card(const std::string& file) {
  const CardModel& model = card_model(plans_.card->installation.kind);
  std::vector<std::unique_ptr<io::HidPort>> ports;
  ScanCard::Ports borrowed;
  for (int i = 0; i <= static_cast<int>(model.interfaces); ++i) {
    io::HidAddress address = ScanCard::address(model, i);
    address.serial = plans_.card->serial;
    ports.push_back(std::make_unique<io::HidPort>(std::move(address)));
    borrowed.push_back(ports.back().get());
  }
  const auto pass = [this](Duration span) { clock_.pass(span); };
  const auto found = patient::check_card(*plans_.card, borrowed, clock_, pass, talk_);
  if (!found) return tl::unexpected{found.error()};
  return calibrated_text(plans_.text, file, *found);
}

}  // namespace palp::patient
