#include "patient_site/device_check.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "common/io/device/hid_port.h"
#include "common/io/device/modbus_port.h"
#include "patient_site/axis_check.h"
#include "patient_site/devices/register_device.h"
#include "patient_site/sensor_check.h"
#include "patient_site/settings_devices.h"

namespace palp::patient {
namespace {

template <class Reading>
SensorFeeling feeling_of(const Reading& reading, bool ready) {
  return {.ready = ready,
          .trouble = {},
          .number = reading.number,
          .force = reading.force,
          .zero = reading.zero,
          .saturated = reading.saturated};
}

}  // namespace

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
  if (plan.profile.move) {
    auto found = AxisCheck{plan, port, clock_, pass, talk_}.run();
    if (!found) return tl::unexpected{found.error()};
    plan = std::move(*found);
  }
  if (plan.profile.force) {
    if (const auto felt = check_force(plan, port); !felt) return tl::unexpected{felt.error()};
  }
  return calibrated_text(plans_.text, file, name, plan);
}

Result<void> DeviceCheck::check_force(DevicePlan& plan, io::RegisterPort& port) {
  RegisterDevice device{plan.profile, plan.installation, port};
  const auto step = [&] {
    clock_.pass(plan.profile.period);
    const DeviceReading reading = device.cycle(clock_, {});
    SensorFeeling felt = feeling_of(reading, reading.state == DeviceState::Ready);
    if (reading.state == DeviceState::Fault) felt.trouble = describe_reason(reading, plan.profile);
    return felt;
  };
  const auto found = check_sensor(step, clock_, talk_);
  device.stop();
  port.close();
  if (!found) return tl::unexpected{found.error()};
  DeviceInstallation& built_in = plan.installation;
  const double unit = built_in.force_unit > 0 ? built_in.force_unit : plan.profile.force->unit;
  if (found->scale != 1) built_in.force_unit = unit * std::abs(found->scale);
  if (found->scale < 0) built_in.force_reversed = !built_in.force_reversed;
  built_in.force_zero = found->zero * found->scale;
  plan.noise = found->noise * std::abs(found->scale);
  return {};
}

Result<std::string> DeviceCheck::check_card(const std::string& file) {
  CardPlan plan = *plans_.card;
  const CardModel& model = card_model(plan.installation.kind);
  std::vector<std::unique_ptr<io::HidPort>> ports;
  ScanCard::Ports borrowed;
  for (int i = 0; i <= static_cast<int>(model.interfaces); ++i) {
    io::HidAddress address = ScanCard::address(model, i);
    address.serial = plan.serial;
    ports.push_back(std::make_unique<io::HidPort>(std::move(address)));
    borrowed.push_back(ports.back().get());
  }
  ScanCard card{plan.installation, borrowed};
  const auto step = [&] {
    clock_.pass(std::chrono::milliseconds{1});
    const CardReading reading = card.cycle(clock_, {});
    SensorFeeling felt = feeling_of(reading, reading.state == CardState::Ready);
    if (reading.state == CardState::Fault) felt.trouble = reading.why;
    return felt;
  };
  const auto found = check_sensor(step, clock_, talk_);
  card.stop();
  if (!found) return tl::unexpected{found.error()};
  plan.installation.newtons_per_volt *= found->scale;
  plan.installation.load.force_zero = found->zero * found->scale;
  plan.noise = found->noise * std::abs(found->scale);
  return calibrated_text(plans_.text, file, plan);
}

}  // namespace palp::patient
