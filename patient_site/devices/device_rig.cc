#include "patient_site/devices/device_rig.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "common/core/check.h"
#include "common/io/device/hid_port.h"
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

std::string sentence_of(const std::string& product, const CardReading& card) {
  const std::string text = "force sensor (" + product + "): " + std::string{to_string(card.state)};
  return card.why.empty() ? text : text + ", " + std::string{card.why};
}

/// What became of a tare since `before`; nullopt: nothing new.
std::optional<DeviceNews> tare_news(const std::string& who,
                                    const TareNews& before,
                                    const TareNews& now) {
  if (now.refused != before.refused) {
    return DeviceNews{who + ": the tare was refused, " + std::string{now.why}, false};
  }
  if (now.taken == before.taken) return std::nullopt;
  std::array<char, 64> moved{};
  (void)std::snprintf(
      moved.data(), moved.size(), ": tared, its zero has moved by %.0f mN", now.moved * 1e3);
  return DeviceNews{who + moved.data(), true};
}

std::unique_ptr<CardThread> make_card(const CardPlan& plan, int priority) {
  CardThread::Ports ports;
  const CardModel& model = card_model(plan.installation.kind);
  for (std::size_t i = 0; i <= model.interfaces; ++i) {
    io::HidAddress address = ScanCard::address(model, static_cast<int>(i));
    address.serial = plan.serial;
    ports.push_back(std::make_unique<io::HidPort>(std::move(address)));
  }
  return std::make_unique<CardThread>(plan.installation, std::move(ports), priority);
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
  if (plans.card) {
    card_name_ = card_model(plans.card->installation.kind).name;
    card_ = make_card(*plans.card, priority);
    force_ = std::make_unique<CardForce>(*card_, facts.sensor);
    feeling_ = &card_->requests();
  } else {
    DeviceThread& feels = cell != nullptr ? *cell : *normal;
    force_ = std::make_unique<RegisterForce>(feels, facts.sensor);
    feeling_ = &feels.requests();
  }
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
  if (card_ && card_->status().state != CardState::Ready) return false;
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
  if (!card_) return std::nullopt;
  const CardReading& card = card_->status();
  if (card.state == CardState::Ready) return std::nullopt;
  const bool given_up = card.state == CardState::Fault || waited >= kReachPatience;
  return given_up ? std::optional{sentence_of(card_name_, card)} : std::nullopt;
}

std::vector<DeviceNews> DeviceRig::news() {
  std::vector<DeviceNews> all;
  if (card_) {
    const CardReading& card = card_->status();
    const bool same_state = std::exchange(card_state_, card.state) == card.state;
    const bool same_why = std::exchange(card_why_, card.why) == card.why;
    if (!same_state || !same_why) all.push_back({sentence_of(card_name_, card), card.why.empty()});
    const TareNews before = std::exchange(card_tare_, card.tare);
    if (auto news = tare_news("force sensor (" + card_name_ + ")", before, card.tare)) {
      all.push_back(std::move(*news));
    }
  }
  for (std::size_t i = 0; i < threads_.size(); ++i) {
    const DeviceReading& reading = threads_[i]->status();
    const std::uint32_t silences = threads_[i]->silences();
    const Known before =
        std::exchange(known_[i], {reading.state, reading.reason, reading.tare, silences});
    if (before.state != reading.state || before.reason != reading.reason) {
      all.push_back({sentence_of(*threads_[i]), reading.reason == DeviceReason::None});
    }
    const std::string who = threads_[i]->name() + " (" + threads_[i]->profile().name + ")";
    if (before.silences != silences) {
      all.push_back({who + ": its answers came too late for the site", false});
    }
    if (auto news = tare_news(who, before.tare, reading.tare)) all.push_back(std::move(*news));
  }
  return all;
}

void DeviceRig::restart() noexcept {
  for (const auto& device : threads_) device->requests().restart();
  if (card_) card_->requests().restart();
}

void DeviceRig::tare() noexcept { feeling_->tare(); }

}  // namespace palp::patient
