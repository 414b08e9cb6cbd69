#pragma once

#include <bit>
#include <map>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/io/device/hid_port.h"
#include "patient_site/devices/scan_card.h"
#include "tests/common/io/device/fake_hidapi.h"
#include "tests/common/io/device/fake_registers.h"

namespace palp::patient {

inline CardInstallation card_built_in(CardKind kind) {
  CardInstallation made;
  made.kind = kind;
  made.newtons_per_volt = 5;
  made.load.tare_time = std::chrono::milliseconds{20};
  return made;
}

/// A card of the fake of hidapi, in virtual time, with a memory and a quiet sensor.
class CardBench : public testing::Test {
 protected:
  explicit CardBench(CardKind kind = CardKind::Usb1608) {
    const CardModel& model = card_model(kind);
    interfaces_ = static_cast<unsigned>(model.interfaces);
    for (int i = 0; i <= static_cast<int>(model.interfaces); ++i) {
      fake_hid::Device made;
      made.path = "card" + std::to_string(i);
      made.vendor = 0x09DB;
      made.product = model.product;
      made.interface_number = i;
      raw_.push_back(&fake_hid::plug(made));
      ports_.push_back(std::make_unique<io::HidPort>(ScanCard::address(model, i)));
    }
    remember(0x80, 5.0F);
    remember(0x90, 0.0F);
    remember(0xA0, -5.0F);
    for (int channel = 0; channel < 8; ++channel) {
      remember(0xB0 + 4 * channel, 0x8000);
      remember(0xB2 + 4 * channel, 0xC000);
      remember(0x130 + 2 * channel, 0x4000);
    }
    raw_[0]->on_write = [this](const fake_hid::Bytes& bytes) {
      if (bytes[0] != 0x30 || bytes.size() != 5) return;
      fake_hid::Bytes reply{0x30};
      for (int i = 0; i < bytes[4]; ++i) reply.push_back(memory_[bytes[1] + 256 * bytes[2] + i]);
      raw_[0]->input.push_back(reply);
    };
    ScanCard::Ports all;
    for (const auto& one : ports_) all.push_back(one.get());
    card_ = std::make_unique<ScanCard>(card_built_in(kind), all);
  }
  ~CardBench() override {
    ports_.clear();
    fake_hid::clear();
  }
  void remember(int address, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int i = 0; i < 4; ++i) memory_[address + i] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
  void remember(int address, int word) {
    memory_[address] = static_cast<std::uint8_t>(word & 0xFF);
    memory_[address + 1] = static_cast<std::uint8_t>(word >> 8);
  }
  /// A packet of samples around `raw`, as a quiet sensor gives them.
  void packet(int raw, int noise = 2) {
    fake_hid::Bytes bytes(64);
    for (std::size_t i = 0; i < 31; ++i) {
      const auto sample = static_cast<unsigned>(raw + (i % 2 == 0 ? noise : -noise) * (i < 30));
      bytes[2 * i] = static_cast<std::uint8_t>(sample & 0xFFU);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(sample >> 8U);
    }
    bytes[62] = static_cast<std::uint8_t>(index_ & 0xFFU);
    bytes[63] = static_cast<std::uint8_t>(index_ >> 8U);
    raw_[1 + index_ % interfaces_]->input.push_back(bytes);
    ++index_;
  }
  CardReading step() {
    clock_.at += std::chrono::milliseconds{1};
    return card_->cycle(clock_, asks_);
  }
  CardReading run(int steps, int raw, int noise = 2) {
    CardReading reading;
    for (int i = 0; i < steps; ++i) {
      packet(raw, noise);
      reading = step();
    }
    return reading;
  }

  TestClock clock_;
  std::vector<fake_hid::Device*> raw_;
  std::vector<std::unique_ptr<io::HidPort>> ports_;
  std::map<int, std::uint8_t> memory_;
  std::unique_ptr<ScanCard> card_;
  std::uint16_t index_{};
  unsigned interfaces_{};
  DeviceAsks asks_;
};

}  // namespace palp::patient
