#include "patient_site/devices/device_rig.h"

#include <algorithm>
#include <utility>

#include "common/core/check.h"
#include "common/io/device/modbus_port.h"

namespace palp::patient {
namespace {

constexpr Duration kReachPatience = std::chrono::seconds{5};
constexpr Duration kStartPatience = std::chrono::seconds{90};  // a drive may home

std::string sentence_of(DeviceThread& device) {
  const DeviceReading& reading = device.status();
  std::string text =
      device.name() + " (" + device.profile().name + "): " + std::string{to_string(reading.state)};
  const std::string why = describe_reason(reading, device.profile());
  return why.empty() ? text : text + ", " + why;
}

}  // namespace

DeviceRig::DeviceRig(const DevicePlans& plans, int priority) {
  DeviceThread* const normal = add("normal axis", plans.normal, priority);
  PALP_CHECK(normal != nullptr, "a stage has an axis along the normal");
  DeviceThread* const x = add("x axis", plans.x, priority);
  DeviceThread* const y = add("y axis", plans.y, priority);
  DeviceThread* const cell = add("force sensor", plans.cell, priority);
  const PatientDevices facts = facts_of(plans);
  stage_ = std::make_unique<RegisterStage>(std::array<DeviceThread*, 3>{normal, x, y}, facts.stage);
  force_ = std::make_unique<RegisterForce>(cell != nullptr ? *cell : *normal, facts.sensor);
}

DeviceThread* DeviceRig::add(const std::string& name,
                             const std::optional<DevicePlan>& plan,
                             int priority) {
  if (!plan) return nullptr;
  threads_.push_back(std::make_unique<DeviceThread>(name,
                                                    plan->profile,
                                                    plan->installation,
                                                    std::make_unique<io::ModbusPort>(plan->address),
                                                    priority));
  known_.push_back({});
  return threads_.back().get();
}

bool DeviceRig::ready() noexcept {
  return std::ranges::all_of(
      threads_, [](const auto& device) { return device->status().state == DeviceState::Ready; });
}

std::optional<std::string> DeviceRig::hopeless(Duration waited) {
  for (const auto& device : threads_) {
    const DeviceState state = device->status().state;
    if (state == DeviceState::Ready) continue;
    const Duration patience = state == DeviceState::Absent ? kReachPatience : kStartPatience;
    if (state == DeviceState::Fault || waited >= patience) return sentence_of(*device);
  }
  return std::nullopt;
}

std::vector<DeviceNews> DeviceRig::news() {
  std::vector<DeviceNews> all;
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    const DeviceReading& reading = threads_[i]->status();
    const Known before = std::exchange(known_[i], {reading.state, reading.reason});
    if (before.state != reading.state || before.reason != reading.reason) {
      all.push_back({sentence_of(*threads_[i]), reading.reason == DeviceReason::None});
    }
  }
  return all;
}

void DeviceRig::restart() noexcept {
  for (const auto& device : threads_) device->restart();
}

}  // namespace palp::patient
